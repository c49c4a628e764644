//! Lit spheres: how a surface of a style looks in each direction that it may face (Bruckner and Gröller, "Style transfer functions for
//! illustrative volume rendering", 2007).

use glam::{DVec2, DVec3};

/// A way to draw surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Style {
    /// Matt, warm where lit and cool where not (Gooch et al. 1998).
    Clay,
    /// Matt with a small highlight.
    Porcelain,
    /// Bands of light and dark, as of a polished surface.
    Metal,
    /// Paper with dark outlines.
    Ink,
    /// Clear where it faces the eye, visible along silhouettes.
    Glass,
}

impl Style {
    /// Every style.
    pub const ALL: &[Self] = &[Self::Clay, Self::Porcelain, Self::Metal, Self::Ink, Self::Glass];

    /// Name as written on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clay => "clay",
            Self::Porcelain => "porcelain",
            Self::Metal => "metal",
            Self::Ink => "ink",
            Self::Glass => "glass",
        }
    }

    /// The style of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|style| style.name() == name)
    }

    /// How a surface looks whose unit normal in eye space is (x, y, √(1 − x² − y²)): +x to the right, +y up, +z to the eye.
    fn look(self, normal: DVec3) -> Look {
        // From above, to the left, in front.
        let to_light = DVec3::new(-0.45, 0.55, 0.705);
        let lit = normal.dot(to_light).max(0.0);
        let highlight = |sharpness: i32| (2.0 * lit * normal.z - to_light.z).max(0.0).powi(sharpness);
        let matt = |level: f64| Look { rgb: [level; 3], gloss: 0.0, density: 1.0 };
        match self {
            Self::Clay => {
                let warm = 0.5 + 0.5 * normal.dot(to_light);
                let mix = |cool: f64, hot: f64| cool + (hot - cool) * warm;
                Look { rgb: [mix(0.25, 1.0), mix(0.25, 0.95), mix(0.45, 0.85)], ..matt(0.0) }
            }
            Self::Porcelain => Look { gloss: 0.6 * highlight(40), ..matt(0.35 + 0.65 * lit) },
            Self::Metal => {
                let band = 0.5 + 0.5 * (7.0 * normal.y + 2.0 * normal.x).sin();
                Look { gloss: 0.5 * highlight(24), ..matt(0.2 + 0.5 * band + 0.3 * lit) }
            }
            Self::Ink => {
                let inside = ((normal.z - 0.25) / 0.25).clamp(0.0, 1.0);
                matt(inside * inside * (3.0 - 2.0 * inside))
            }
            Self::Glass => {
                let outline = (1.0 - normal.z) * (1.0 - normal.z);
                Look { gloss: 0.8 * highlight(60), density: 0.1 + 0.9 * outline, ..matt(1.0) }
            }
        }
    }
}

/// What becomes of a sample.
#[derive(Debug, Clone, Copy)]
struct Look {
    /// By which its colour is multiplied.
    rgb: [f64; 3],
    /// White that is added to its colour.
    gloss: f64,
    /// By which its density is multiplied.
    density: f64,
}

/// Texels along a side of a map.
pub const LIT_SPHERE_SIDE: usize = 64;

/// Numbers of a texel: three that the colour is multiplied by, white that is added, and one that the density is multiplied by.
pub const LIT_SPHERE_CHANNELS: usize = 5;

/// A map of looks by normals: texel (i, j) is that of the normal with x = 2 i/(n − 1) − 1 and y = 2 j/(n − 1) − 1; beyond the unit circle
/// as on it. Plane by plane, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct LitSphere {
    numbers: Vec<f32>,
}

impl LitSphere {
    /// The map of a style.
    pub fn of(style: Style) -> Self {
        let last = (LIT_SPHERE_SIDE - 1) as f64;
        let texels: Vec<Look> = (0..LIT_SPHERE_SIDE * LIT_SPHERE_SIDE)
            .map(|i| {
                let at =
                    DVec2::new((i % LIT_SPHERE_SIDE) as f64, (i / LIT_SPHERE_SIDE) as f64) / last * 2.0 - 1.0;
                let on_sphere = at / at.length().max(1.0);
                style.look(on_sphere.extend((1.0 - on_sphere.length_squared()).max(0.0).sqrt()))
            })
            .collect();
        let plane = |of: fn(&Look) -> f64| texels.iter().map(move |look| of(look) as f32);
        let numbers = plane(|l| l.rgb[0])
            .chain(plane(|l| l.rgb[1]))
            .chain(plane(|l| l.rgb[2]))
            .chain(plane(|l| l.gloss))
            .chain(plane(|l| l.density));
        Self { numbers: numbers.collect() }
    }

    /// The numbers, plane by plane in the order of the channels.
    pub fn numbers(&self) -> &[f32] {
        &self.numbers
    }

    /// One channel of all texels, row by row.
    pub fn plane(&self, channel: usize) -> &[f32] {
        let texels = LIT_SPHERE_SIDE * LIT_SPHERE_SIDE;
        &self.numbers[channel * texels..(channel + 1) * texels]
    }
}
