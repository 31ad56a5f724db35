//! Files of frames for other programs: `sorb run --export`.

mod bodies;
mod gltf;
mod npy;
mod ply;
mod snapshot;
#[cfg(feature = "surface")]
mod surface;
mod vtp;

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use sorb::World;

use crate::error::CliError;
use snapshot::Snapshot;

/// Kinds of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Format {
    /// VTK poly data of water, sponges and bodies with a series (.pvd), for `ParaView`
    Vtp,
    /// Points of the water, meshes of sponges and bodies, for Blender and `MeshLab`
    Ply,
    /// Columns and poses as arrays of `NumPy`
    Npy,
    /// Water as points, sponges and bodies as meshes in one binary glTF file
    Gltf,
    /// Surface of the water as a mesh in PLY, with vtp as VTK poly data too; of programs with the feature `surface`
    Surface,
}

/// Refuses formats that the program was built without.
///
/// # Errors
/// [`CliError::Usage`].
pub(crate) fn check(formats: &[Format]) -> Result<(), CliError> {
    if cfg!(feature = "surface") || !formats.contains(&Format::Surface) {
        return Ok(());
    }
    Err(CliError::Usage(
        "this program was built without meshes of water; this one has them:\n\
         cargo run --release -p sorb-cli --features surface -- run SCENE --export surface"
            .to_owned(),
    ))
}

/// Extensions of all files.
pub(crate) const EXTENSIONS: [&str; 5] = ["vtp", "pvd", "ply", "npy", "glb"];

/// The files of a run while they are written.
#[derive(Debug)]
pub(crate) struct Exports {
    folder: PathBuf,
    formats: Vec<Format>,
    /// Frames from an exported one to the next.
    every: usize,
    frame_rate: f32,
}

impl Exports {
    /// Creates the folder.
    ///
    /// # Errors
    /// It cannot be made.
    pub(crate) fn create(
        folder: PathBuf,
        (formats, every): (&[Format], u32),
        frame_rate: f32,
    ) -> Result<Self, CliError> {
        fs::create_dir_all(&folder).map_err(CliError::write(&folder))?;
        Ok(Self { folder, formats: formats.to_vec(), every: every as usize, frame_rate })
    }

    /// Writes the files of a frame, if it is due.
    ///
    /// # Errors
    /// A file cannot be written.
    pub(crate) fn frame(&self, frame: usize, world: &World) -> Result<(), CliError> {
        if !frame.is_multiple_of(self.every) {
            return Ok(());
        }
        let snapshot = Snapshot::of(world);
        for format in &self.formats {
            let files: Vec<(String, Vec<u8>)> = match format {
                Format::Vtp => vtp::files(&snapshot),
                Format::Ply => ply::files(&snapshot),
                Format::Npy => npy::files(&snapshot),
                Format::Gltf => vec![("scene.glb".to_owned(), gltf::file(&snapshot)?)],
                #[cfg(feature = "surface")]
                Format::Surface => self.surface(world)?,
                // `check` has refused it.
                #[cfg(not(feature = "surface"))]
                Format::Surface => Vec::new(),
            };
            for (name, bytes) in files {
                let (stem, extension) = name.split_once('.').unwrap_or((&name, ""));
                let path = self.folder.join(format!("{stem}_{frame:05}.{extension}"));
                fs::write(&path, bytes).map_err(CliError::write(path))?;
            }
        }
        Ok(())
    }

    #[cfg(feature = "surface")]
    fn surface(&self, world: &World) -> Result<Vec<(String, Vec<u8>)>, CliError> {
        let (vertices, triangles) = surface::surface(world)?;
        let mut files = vec![("surface.ply".to_owned(), ply::mesh(&vertices, &triangles))];
        if self.formats.contains(&Format::Vtp) {
            let text = vtp::mesh(&vertices, &triangles, |_| ());
            files.push(("surface.vtp".to_owned(), text.into_bytes()));
        }
        Ok(files)
    }

    /// Writes the series, of all frames that are there.
    ///
    /// # Errors
    /// A file cannot be written.
    pub(crate) fn finish(&self) -> Result<(), CliError> {
        if !self.formats.contains(&Format::Vtp) {
            return Ok(());
        }
        for (stem, paths) in self.poly_data()? {
            let path = self.folder.join(format!("{stem}.pvd"));
            let times = paths.iter().filter_map(|path| {
                let (_, frame) = numbered(path)?;
                let time = f64::from(frame) / f64::from(self.frame_rate);
                Some((time, path.file_name()?.to_str()?))
            });
            fs::write(&path, vtp::series(times)).map_err(CliError::write(path))?;
        }
        Ok(())
    }

    /// Files of poly data in the folder, by stem, in the order of the frames: a run that is continued has those before it.
    fn poly_data(&self) -> Result<BTreeMap<String, Vec<PathBuf>>, CliError> {
        let mut files: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
        let entries = fs::read_dir(&self.folder).map_err(CliError::read(&self.folder))?;
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort_by_key(|path| numbered(path).map(|(_, frame)| frame));
        for path in paths.into_iter().filter(|path| path.extension().is_some_and(|own| own == "vtp")) {
            if let Some((stem, _)) = numbered(&path) {
                files.entry(stem).or_default().push(path);
            }
        }
        Ok(files)
    }
}

/// Stem and frame of a file such as `water_00012.vtp`.
fn numbered(path: &Path) -> Option<(String, u32)> {
    let (stem, frame) = path.file_stem()?.to_str()?.rsplit_once('_')?;
    let is_number = frame.len() >= 5 && frame.bytes().all(|byte| byte.is_ascii_digit());
    Some((stem.to_owned(), frame.parse().ok().filter(|_| is_number)?))
}
