//! What the fuzz targets share: bytes → regions full of degeneracies, and the laws a mesh keeps.

pub mod laws;
pub mod scene;
pub mod source;

/// Lets all work run on the calling thread: handing a small mesh to other threads takes longer than
/// building it, and libFuzzer's coverage counters want one thread.
pub fn on_this_thread() {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global()
        .expect("nothing ran before");
}

/// Prints a scene where `GLOBEFILL_SHOW` is set: to read a find.
pub fn show(options: &globefill::MeshOptions, regions: &[globefill::Region]) {
    static IS_ASKED: std::sync::LazyLock<bool> =
        std::sync::LazyLock::new(|| std::env::var_os("GLOBEFILL_SHOW").is_some());
    if *IS_ASKED {
        eprintln!("{options:?}\n{regions:#?}");
    }
}
