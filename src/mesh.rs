//! From arcs to the mesh: points on the true edges, caps on the ellipsoid, bounds.

pub(crate) mod bounds;
pub(crate) mod caps;
pub(crate) mod chunks;
pub(crate) mod densify;
pub(crate) mod levels;
pub(crate) mod mesh_build;
pub(crate) mod simplify;
pub(crate) mod triangulate;
pub(crate) mod vertex_room;
pub(crate) mod vertex_runs;
pub(crate) mod vertex_tree;
