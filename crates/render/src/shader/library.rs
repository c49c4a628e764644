//! The embedded WGSL files.

macro_rules! files {
    ($($path:literal,)*) => {
        /// Every file: path below `shaders/` without its ending, and text.
        pub const FILES: &[(&str, &str)] =
            &[$(($path, include_str!(concat!("../../shaders/", $path, ".wgsl"))),)*];
    };
}

files! {
    "cast",
    "lib/accumulate_composite",
    "lib/accumulate_first_hit",
    "lib/accumulate_mean",
    "lib/accumulate_minip",
    "lib/accumulate_mip",
    "lib/accumulate_xray",
    "lib/cast_parameters",
    "lib/classified",
    "lib/classify_isovalue",
    "lib/classify_preintegrated",
    "lib/classify_value",
    "lib/classify_value_gradient",
    "lib/composite",
    "lib/extreme_value",
    "lib/gradient_central",
    "lib/gradient_tetrahedron",
    "lib/lut_1d",
    "lib/lut_2d",
    "lib/ray",
    "lib/ray_state",
    "lib/shade_ambient",
    "lib/shade_directional",
    "lib/shade_none",
    "lib/shade_phong",
    "lib/shade_shadow",
    "lib/shading_ray",
    "lib/value_sum",
    "lib/view",
    "lib/volume",
}
