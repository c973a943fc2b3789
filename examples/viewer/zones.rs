//! Threat zones: hatched, outlined, bounded by true curves.

use std::f32::consts::FRAC_PI_4;

use globefill::{
    FillMesh, FillStyle, Hatch, HatchKind, Length, LonLat, MeshId, MeshOptions, Pattern, Region,
    Renderer, Stroke, Zone,
};

/// The layer of zones.
pub struct Zones {
    pub shown: bool,
    pub outlined: bool,
    pub kind: HatchKind,
    /// From line to line.
    pub spacing_px: f32,
    colors: Vec<[f32; 3]>,
    mesh: MeshId,
    last: Option<FillStyle>,
}

const RED: [f32; 3] = [0.9, 0.08, 0.05];
const AMBER: [f32; 3] = [0.95, 0.45, 0.03];
const VIOLET: [f32; 3] = [0.5, 0.12, 0.85];

fn zones() -> Vec<(Zone, [f32; 3])> {
    let at = LonLat::new;
    let channel = vec![at(-6.5, 48.6), at(-2.0, 49.7), at(1.4, 50.9), at(3.2, 52.2)];
    vec![
        (Zone::circle(at(33.5, 44.5), 250e3), RED),
        (Zone::sector(at(41.0, 37.5), 20e3, 400e3, 120.0, 215.0), RED),
        (Zone::circle(at(56.3, 26.6), 180e3), AMBER),
        (Zone::annulus(at(120.9, 23.7), 150e3, 420e3), AMBER),
        (Zone::corridor(channel, 60e3), VIOLET),
        (Zone::circle(at(-175.0, 52.0), 600e3), VIOLET),
        (Zone::circle(at(0.0, 90.0), 500e3), AMBER),
    ]
}

impl Zones {
    pub fn new(renderer: &mut Renderer) -> Result<Self, String> {
        let (zones, colors): (Vec<Zone>, Vec<_>) = zones().into_iter().unzip();
        let regions: Vec<Region> = zones.into_iter().map(Region::from).collect();
        let mesh = FillMesh::build(&regions, &MeshOptions::default())
            .map_err(|error| error.to_string())?;
        Ok(Self {
            shown: true,
            outlined: true,
            kind: HatchKind::Lines,
            spacing_px: 9.0,
            colors,
            mesh: renderer.insert(mesh),
            last: None,
        })
    }

    /// Gives the renderer what changed.
    pub fn restyle(&mut self, renderer: &mut Renderer) -> Result<(), String> {
        let hatch = Hatch {
            kind: self.kind,
            spacing: Length::Pixels(self.spacing_px),
            share: 0.35,
            angle_rad: FRAC_PI_4,
            ..Default::default()
        };
        let style = FillStyle {
            pattern: Some(Pattern::Hatch(hatch)),
            stroke: self.outlined.then(|| Stroke {
                width: Length::Pixels(2.0),
                ..Default::default()
            }),
            visible: self.shown,
            z_index: 1,
            ..Default::default()
        };
        if self.last.replace(style) == Some(style) {
            return Ok(());
        }
        for (fill, &[red, green, blue]) in (0..).zip(&self.colors) {
            let inked = |alpha| [red, green, blue, alpha];
            let own = FillStyle {
                color: inked(0.25),
                pattern: Some(Pattern::Hatch(Hatch {
                    color: inked(0.9),
                    ..hatch
                })),
                stroke: style.stroke.map(|stroke| Stroke {
                    color: inked(1.0),
                    ..stroke
                }),
                ..style
            };
            renderer
                .set_style(self.mesh, fill, own)
                .map_err(|error| error.to_string())?;
        }
        Ok(())
    }
}
