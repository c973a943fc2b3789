//! Prints what fills take on the GPU, beside the layouts of the 2007 paper that the method comes from
//! (a mesh whose triangles a geometry shader extrudes, against volumes made on the CPU) and beside
//! doubled vertices at our own precision.

use globefill::{
    FillMesh, MeshOptions,
    countries::{Country, Dataset},
};

/// Vertices, triangles and boundary edges of a plain surface mesh.
struct Surface {
    vertices: u64,
    triangles: u64,
    edges: u64,
}

impl Surface {
    /// As if every fill were a mesh of its own: borders twice, no arcs.
    fn of(countries: &[Country]) -> Self {
        let mut surface = Self {
            vertices: 0,
            triangles: 0,
            edges: 0,
        };
        for country in countries {
            let mesh = build(std::slice::from_ref(country));
            let closing = mesh.arcs.len() as u64;
            surface.vertices += mesh.vertices.len() as u64 - closing;
            surface.edges += mesh.boundary.len() as u64 - closing;
            surface.triangles += mesh.cap_triangles.len() as u64;
        }
        surface
    }

    /// 24-byte vertices and 16-bit indices, extruded by a geometry shader.
    fn paper_bytes(&self) -> u64 {
        24 * self.vertices + 2 * 3 * self.triangles
    }

    /// The same with a volume of eight triangles made of each on the CPU.
    fn paper_volume_bytes(&self) -> u64 {
        2 * 24 * self.vertices + 6 * 2 * 3 * self.triangles
    }

    /// Every vertex at top and bottom in our 16 bytes; 32-bit indices of two caps and the walls.
    fn doubled_bytes(&self) -> u64 {
        2 * 16 * self.vertices + 4 * (2 * 3 * self.triangles + 6 * self.edges)
    }
}

fn build(countries: &[Country]) -> FillMesh {
    let regions: Vec<_> = countries
        .iter()
        .map(|country| country.region.clone())
        .collect();
    FillMesh::build(&regions, &MeshOptions::default()).expect("embedded data is valid")
}

fn main() {
    let states = Dataset::UsStates.countries();
    let california: Vec<_> = states
        .into_iter()
        .filter(|state| state.name == "California")
        .collect();
    let sets = [
        ("California", california),
        ("countries 110m", Dataset::Countries110m.countries()),
        ("countries 50m", Dataset::Countries50m.countries()),
    ];
    println!(
        "{:16} {:>8} {:>9} {:>12} {:>12} {:>10} {:>10} {:>5}",
        "", "vertices", "triangles", "paper, GS", "paper, CPU", "doubled", "globefill", "ratio"
    );
    let paper = Surface {
        vertices: 1_056,
        triangles: 1_107,
        edges: 0,
    };
    println!(
        "{:16} {:>8} {:>9} {:>12} {:>12}",
        "California, 2007",
        paper.vertices,
        paper.triangles,
        paper.paper_bytes(),
        paper.paper_volume_bytes()
    );
    for (name, countries) in sets {
        let surface = Surface::of(&countries);
        let (doubled, ours) = (surface.doubled_bytes(), build(&countries).gpu_bytes());
        println!(
            "{name:16} {:>8} {:>9} {:>12} {:>12} {doubled:>10} {ours:>10} {:>4.0}%",
            surface.vertices,
            surface.triangles,
            surface.paper_bytes(),
            surface.paper_volume_bytes(),
            100.0 * ours as f64 / doubled as f64
        );
    }
}
