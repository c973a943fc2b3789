//! From rings to arcs: validated, noded, oriented, and every border once.

mod alongside;
pub(crate) mod arcs;
pub(crate) mod authalic;
pub(crate) mod bound_polygons;
pub(crate) mod boundary_graph;
pub(crate) mod curved_meeting;
pub(crate) mod edge_grid;
pub(crate) mod edge_star;
pub(crate) mod headings;
pub(crate) mod inside;
pub(crate) mod lattice;
pub(crate) mod lattice_box;
pub(crate) mod meeting;
pub(crate) mod meridian_index;
pub(crate) mod noding;
pub(crate) mod overlaps;
pub(crate) mod rings;
pub(crate) mod simple_loops;
pub(crate) mod winding;
pub(crate) mod zones;
