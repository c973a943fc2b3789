//! What a browser does in its own way: the functions of `desktop.rs`, not written yet.

compile_error!(
    "the viewer's browser side is not written yet: see platform/desktop.rs for what it needs"
);
