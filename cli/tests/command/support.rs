//! Runs the command and reads its results.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use serde_json::Value;

/// Exit code and output of the command.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Answer {
    /// Standard output as JSON.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.out).expect("standard output is one JSON value")
    }
}

/// Runs `sorb` with arguments.
pub(crate) fn sorb(arguments: &[&str]) -> Answer {
    run(Path::new(env!("CARGO_BIN_EXE_sorb")), arguments)
}

/// Runs a program with arguments.
pub(crate) fn run(program: &Path, arguments: &[&str]) -> Answer {
    let output =
        Command::new(program).args(arguments).stdin(Stdio::null()).output().expect("the command starts");
    answer(output)
}

fn answer(output: Output) -> Answer {
    let text = |bytes| String::from_utf8(bytes).expect("text is UTF-8");
    Answer { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
}

/// A folder of one test, empty at its start and removed at its end.
#[derive(Debug)]
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    pub(crate) fn new(test: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
        if path.exists() {
            fs::remove_dir_all(&path).expect("an earlier folder can be removed");
        }
        fs::create_dir_all(&path).expect("the folder can be made");
        Self(path)
    }

    /// Path of something in the folder.
    pub(crate) fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().expect("the path is UTF-8").to_owned()
    }

    /// Writes a file and returns its path.
    pub(crate) fn write(&self, name: &str, text: &str) -> String {
        let path = self.path(name);
        fs::write(&path, text).expect("the file can be written");
        path
    }

    /// Reads a file.
    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("the file is there")
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // A folder that remains is replaced by the next run.
        let _ = fs::remove_dir_all(&self.0);
    }
}
