//! What fills measure, from their true edges.

use crate::{
    curve::{Curve, CurveOn},
    fill_mesh::{Arc, FillMesh},
    geodetic::LonLat,
    outline::{Cap, Measures, Outline, bounding_cap::centre_of},
};

impl FillMesh {
    /// Area and mean normal of a fill, from its true edges, to 10⁻¹⁰ or the rounding of positions:
    /// see [`Measures`]. Polygons of the fill that overlap count twice, as they do when drawn.
    /// Nothing for a fill that is empty or not there.
    pub fn measures(&self, fill: u32) -> Measures {
        let outlines = self.outlines(fill);
        let pieces = outlines.iter().map(|piece| self.piece_measures(piece));
        pieces.fold(Measures::default(), Measures::plus)
    }

    /// [`Self::measures`] of every fill, in their order: in one pass over the boundary, where asking
    /// fill by fill takes a pass each.
    pub fn all_measures(&self) -> Vec<Measures> {
        let mut sides: Vec<(u32, u32, bool)> = Vec::with_capacity(2 * self.arcs.len());
        for (index, arc) in (0..).zip(&self.arcs) {
            sides.extend(arc.left.map(|piece| (piece, index, true)));
            sides.extend(arc.right.map(|piece| (piece, index, false)));
        }
        sides.sort_unstable();
        let mut rest = &sides[..];
        let pieces = (0_u32..).zip(&self.pieces);
        let mut fills = vec![Measures::default(); self.fills.len()];
        for (index, piece) in pieces {
            let (own, others) = rest.split_at(rest.partition_point(|side| side.0 == index));
            rest = others;
            // One outline at a time: prepared curves are large.
            let mut outline = Outline::new(self.ellipsoid, Vec::new());
            for &(_, arc, is_left) in own {
                self.add_side(&mut outline, &self.arcs[arc as usize], is_left);
            }
            if let Some(fill) = fills.get_mut(piece.fill as usize) {
                *fill = fill.plus(self.piece_measures(&outline));
            }
        }
        fills
    }

    /// Area of a fill on the ellipsoid, m²: that of [`Self::measures`].
    pub fn area_m2(&self, fill: u32) -> f64 {
        self.measures(fill).area_m2
    }

    /// The middle of a fill: [`Measures::centroid`]. It need not lie inside.
    pub fn centroid(&self, fill: u32) -> Option<LonLat> {
        self.measures(fill).centroid()
    }

    /// A cap that holds a fill, about its centroid, or about the north pole where it has none.
    /// None for a fill that is empty or not there.
    ///
    /// Its radius is at most 10⁻⁵ of itself plus 10⁻¹³ rad larger than the least about that centre,
    /// or π where that one is within 10⁻³ rad of π. Proven for flattenings up to 1/50.
    pub fn bounding_cap(&self, fill: u32) -> Option<Cap> {
        let outlines = self.outlines(fill);
        let pieces: Vec<Measures> = outlines
            .iter()
            .map(|piece| self.piece_measures(piece))
            .collect();
        let all = pieces.iter().copied();
        let centre = centre_of(&all.fold(Measures::default(), Measures::plus));
        // A piece without an outline is everything.
        let radius_rad = |(piece, measures): (&Outline<CurveOn>, &Measures)| {
            piece
                .radius_about(centre, measures)
                .unwrap_or(std::f64::consts::PI)
        };
        let radii_rad = outlines.iter().zip(&pieces).map(radius_rad);
        radii_rad
            .reduce(f64::max)
            .map(|radius_rad| Cap { centre, radius_rad })
    }

    /// The true edges along an arc, in its direction.
    pub fn curves_along(&self, arc: &Arc) -> &[Curve] {
        let first = arc.first_vertex as usize;
        let run = self.boundary.get(first..first + arc.vertex_count as usize);
        let ends = run.and_then(|run| Some((run.first()?.curve, run.last()?.curve)));
        let curves = ends.and_then(|(first, last)| self.curves.get(first as usize..=last as usize));
        curves.unwrap_or_default()
    }

    /// The outlines of a fill's pieces; none has no stretches but one that is everything.
    fn outlines(&self, fill: u32) -> Vec<Outline<CurveOn>> {
        let Some(record) = self.fills.get(fill as usize) else {
            return Vec::new();
        };
        let empty = || Outline::new(self.ellipsoid, Vec::new());
        let mut outlines: Vec<_> = (0..record.piece_count).map(|_| empty()).collect();
        for arc in &self.arcs {
            for (side, is_left) in [(arc.left, true), (arc.right, false)] {
                let piece = side.and_then(|piece| piece.checked_sub(record.first_piece));
                let outline = piece.and_then(|piece| outlines.get_mut(piece as usize));
                if let Some(outline) = outline {
                    self.add_side(outline, arc, is_left);
                }
            }
        }
        outlines
    }

    /// Adds an arc to the outline of the piece on one of its sides.
    fn add_side(&self, outline: &mut Outline<CurveOn>, arc: &Arc, is_left: bool) {
        let curves = self.curves_along(arc).iter();
        outline.stretches.extend(curves.map(|curve| {
            let curve = if is_left { *curve } else { curve.reversed() };
            curve.on(&self.ellipsoid)
        }));
    }

    fn piece_measures(&self, piece: &Outline<CurveOn>) -> Measures {
        if piece.stretches.is_empty() {
            Measures::globe(&self.ellipsoid)
        } else {
            piece.measures()
        }
    }
}
