//! The folder that holds the results of one run.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::{error::CliError, export::EXTENSIONS};

/// The folder that holds the results of one run.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Creates the folder, or empties it of the results of an earlier run, unless this run continues it.
    ///
    /// # Errors
    /// The system refuses to create the folder or to remove its contents.
    pub(crate) fn create(path: &Path, continues: bool) -> Result<Self, CliError> {
        fs::create_dir_all(path).map_err(CliError::write(path))?;
        let folder = Self { path: path.to_owned() };
        // Without a table these files do not belong to a run.
        if !continues && folder.table().exists() {
            for old in folder.earlier() {
                fs::remove_file(&old).map_err(CliError::write(old))?;
            }
        }
        Ok(folder)
    }

    /// Results of an earlier run that this one would not overwrite.
    fn earlier(&self) -> Vec<PathBuf> {
        let is_number = |path: &Path| {
            let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
            stem.len() >= 5 && stem.bytes().all(|byte| byte.is_ascii_digit())
        };
        let extension =
            |path: &Path| path.extension().and_then(|own| own.to_str()).unwrap_or_default().to_owned();
        let files =
            |folder: PathBuf| fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        files(self.frames())
            .filter(|path| is_number(path) && extension(path) == "png")
            .chain(files(self.export()).filter(|path| EXTENSIONS.contains(&extension(path).as_str())))
            .chain(
                [self.summary(), self.bodies(), self.film(), self.animation(), self.save()]
                    .into_iter()
                    .filter(|path| path.exists()),
            )
            .collect()
    }

    /// The folder itself.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// A row of measures for every frame.
    pub(crate) fn table(&self) -> PathBuf {
        self.path.join("measures.csv")
    }

    /// A row for every body and frame.
    pub(crate) fn bodies(&self) -> PathBuf {
        self.path.join("bodies.csv")
    }

    /// The run in one JSON object.
    pub(crate) fn summary(&self) -> PathBuf {
        self.path.join("summary.json")
    }

    /// The last state that was saved.
    pub(crate) fn save(&self) -> PathBuf {
        self.path.join("state.sorb")
    }

    /// The folder of the pictures.
    pub(crate) fn frames(&self) -> PathBuf {
        self.path.join("frames")
    }

    /// The folder of the frames for other programs.
    pub(crate) fn export(&self) -> PathBuf {
        self.path.join("export")
    }

    /// All pictures as a film.
    pub(crate) fn film(&self) -> PathBuf {
        self.path.join("film.mp4")
    }

    /// All pictures as one animated PNG.
    pub(crate) fn animation(&self) -> PathBuf {
        self.path.join("animation.png")
    }

    /// Names of what a run leaves in the folder: with a table of bodies, with pictures, with an animation.
    pub(crate) fn contents(bodies: bool, pictures: bool, animation: bool) -> String {
        let bodies = if bodies { ", bodies.csv" } else { "" };
        let pictures = match (pictures, cfg!(feature = "film"), animation) {
            (false, ..) => "",
            (true, true, false) => ", film.mp4, frames/",
            (true, true, true) => ", film.mp4, animation.png, frames/",
            (true, false, _) => ", animation.png, frames/",
        };
        format!("measures.csv{bodies}, summary.json{pictures}")
    }
}
