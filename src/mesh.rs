//! From arcs to the mesh: points on the true edges, caps on the ellipsoid, bounds.

pub(crate) mod bounds;
pub(crate) mod densify;
pub(crate) mod mesh_build;
pub(crate) mod triangulate;
pub(crate) mod vertex_room;
pub(crate) mod vertex_runs;
