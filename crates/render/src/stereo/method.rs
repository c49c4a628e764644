//! How a pair of pictures is made of one cast.

/// How segments of reference rays get to the derived picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Form {
    /// A row of a strip of columns is cast ray after ray and composited on the way; strips are merged.
    #[default]
    Strips,
    /// A workgroup casts a row of neighbouring columns side by side, keeps the segments in its own memory and composites
    /// them; tiles are merged as strips are.
    Tiles,
    /// Segments are left in layers, one for each slab of depth, and composited when all are cast (SP).
    Layers(LayerFormat),
    /// The cast keeps layers of emission and absorption, which the derived view's rays pass through: a volumetric warp (VR §5.3.3).
    /// Only [`Quality::Fast`]; the derived picture has no depths.
    Volumetric,
}

/// How segments are held in layers: premultiplied RGBA.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LayerFormat {
    /// 8 bits per channel: each segment is rounded to a level of 1/255, which is much of what one adds to an X-ray.
    Rgba8Unorm,
    /// Half floats.
    Rgba16Float,
}

/// How much is done for the derived picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Quality {
    /// As SP: segments of the reference eye's rays alone, each in the nearest column. Samples are up to half a column off, and
    /// what these rays do not see behind an edge is missing.
    Nearest,
    /// Segments are shared by the two columns that they are between (DESIGN §5.3); X-rays are as by [`Quality::Nearest`].
    #[default]
    Fast,
    /// Tiles where errors would show are cast directly (DESIGN §5.3): where rays ended that the derived eye would have needed, and
    /// where the picture is fine-grained. Only strips are repaired.
    Repaired,
}

/// How a pair is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct PairMethod {
    /// How segments get to the derived picture.
    pub form: Form,
    /// How much is done for the derived picture.
    pub quality: Quality,
}
