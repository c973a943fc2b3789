//! Runs the examples `render` and `sensors` as a user does.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

/// A directory of its own for one test, removed at the end.
pub struct Workplace {
    directory: PathBuf,
}

impl Workplace {
    pub fn new(name: &str) -> Self {
        let directory =
            std::env::temp_dir().join(format!("globefill-{name}-{}", std::process::id()));
        fs::create_dir_all(&directory).expect("a temporary directory");
        Self { directory }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.directory.join(name)
    }

    pub fn write(&self, name: &str, content: &str) {
        fs::write(self.path(name), content).expect("a temporary file");
    }

    /// Names of all files, sorted.
    #[allow(dead_code)]
    pub fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.directory).expect("the temporary directory");
        let mut names: Vec<String> = entries
            .map(|entry| {
                entry
                    .expect("an entry")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        names.sort();
        names
    }

    /// Runs `render` there.
    #[allow(dead_code)]
    pub fn render(&self, arguments: &[&str]) -> Output {
        self.run("render", arguments)
    }

    /// Runs an example there.
    pub fn run(&self, example: &str, arguments: &[&str]) -> Output {
        Command::new(path_of(example))
            .args(arguments)
            .current_dir(&self.directory)
            // Else the window system's loader complains on machines without one.
            .env("XDG_RUNTIME_DIR", &self.directory)
            .output()
            .expect("the example starts")
    }
}

impl Drop for Workplace {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.directory);
    }
}

/// Runs `render` with every output named, checks that it fails as promised, and returns its error.
#[allow(dead_code)]
pub fn refused(workplace: &Workplace, arguments: &[&str]) -> String {
    let before = workplace.files();
    let outputs = [
        "--out",
        "o.png",
        "--mask",
        "m.png",
        "--ids",
        "i.png",
        "--positions",
        "p.npy",
        "--stats",
        "s.json",
    ];
    let run = workplace.render(&[arguments, &outputs].concat());
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(1), "{arguments:?}: {said}");
    assert_eq!(said.lines().count(), 1, "{arguments:?}: {said}");
    assert!(said.starts_with("error: "), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    assert!(run.stdout.is_empty());
    assert_eq!(
        workplace.files(),
        before,
        "{arguments:?} left something behind"
    );
    said
}

/// `cargo test` builds the examples beside the tests' directory.
fn path_of(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("this test's own path");
    let profile = test
        .parent()
        .and_then(Path::parent)
        .expect("target/PROFILE/deps/TEST");
    let example = profile
        .join("examples")
        .join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    assert!(
        example.exists(),
        "{} is missing: run `cargo build --example {name}` first, as plain `cargo test` does",
        example.display()
    );
    example
}
