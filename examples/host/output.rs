//! Files that appear whole, or not at all.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// Where the picture goes when no output is named; the only directory that is made.
pub const DEFAULT_DIRECTORY: &str = "out";

/// Finished files, held in memory until all of them are ready.
#[derive(Default)]
pub struct Outputs {
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Outputs {
    pub fn add(&mut self, path: &Path, content: Vec<u8>) {
        self.files.push((path.to_owned(), content));
    }

    /// Writes every file beside its final name, then moves them all into place.
    pub fn write(&self) -> Result<(), String> {
        let mut staged = Vec::new();
        let result = self.stage_and_move(&mut staged);
        if result.is_err() {
            for temporary in &staged {
                // Best effort: the first error is the one to report.
                let _ = fs::remove_file(temporary);
            }
        }
        result
    }

    fn stage_and_move(&self, staged: &mut Vec<PathBuf>) -> Result<(), String> {
        for (path, content) in &self.files {
            let mut name = path.file_name().ok_or_else(|| not_a_file(path))?.to_owned();
            name.push(format!(".{}.part", std::process::id()));
            let temporary = path.with_file_name(name);
            if path.parent() == Some(Path::new(DEFAULT_DIRECTORY)) {
                fs::create_dir_all(DEFAULT_DIRECTORY)
                    .map_err(|error| cannot_write(path, &error))?;
            }
            staged.push(temporary.clone());
            fs::write(&temporary, content).map_err(|error| cannot_write(path, &error))?;
        }
        for ((path, _), temporary) in self.files.iter().zip(staged.iter()) {
            fs::rename(temporary, path).map_err(|error| cannot_write(path, &error))?;
        }
        Ok(())
    }
}

/// Says early, before any work, that a file could not be written.
pub fn check_writable(path: &Path) -> Result<(), String> {
    if path.is_dir() || path.file_name().is_none() {
        return Err(not_a_file(path));
    }
    match path.parent() {
        Some(parent) if parent == Path::new(DEFAULT_DIRECTORY) => Ok(()),
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => Err(format!(
            "{}: there is no directory {}",
            path.display(),
            parent.display()
        )),
        _ => Ok(()),
    }
}

fn not_a_file(path: &Path) -> String {
    format!("{}: not the name of a file", path.display())
}

fn cannot_write(path: &Path, error: &std::io::Error) -> String {
    format!("{}: cannot write: {error}", path.display())
}
