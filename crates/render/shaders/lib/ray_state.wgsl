// What a ray has gathered so far; kept between dispatches when a ray is cast in several parts.
struct RayState {
    // Premultiplied colour.
    color: vec3f,
    // What still passes through.
    transmittance: f32,
    // Depth of the first hit, metres; NOTHING_HIT without one.
    depth_m: f32,
    // The value before, the best value or the sum of values: each accumulator's own.
    scalar: f32,
    // Samples taken.
    samples: u32,
    // Reads of the skip map.
    map_reads: u32,
    // 1 when no later sample can change the pixel.
    is_finished: u32,
}

// Depth where nothing was hit: the largest f32.
const NOTHING_HIT: f32 = 3.4028234e38;

// Accumulated opacity at which a ray has hit something: the first that an 8-bit picture shows.
const FIRST_HIT_ALPHA: f32 = 1.0 / 255.0;

struct Pixel {
    // Premultiplied RGBA.
    color: vec4f,
    // Depth of the first hit, metres.
    depth_m: f32,
    // Samples taken along the ray, those of shading not counted.
    samples: u32,
    // Reads of the skip map along the ray.
    map_reads: u32,
}

// A ray before its first sample.
fn new_ray_state(scalar: f32, depth_m: f32) -> RayState {
    return RayState(vec3f(0.0), 1.0, depth_m, scalar, 0u, 0u, 0u);
}

fn pixel_of(color: vec4f, state: RayState) -> Pixel {
    return Pixel(color, state.depth_m, state.samples, state.map_reads);
}

fn opaque_pixel(rgb: vec3f, state: RayState) -> Pixel {
    return pixel_of(vec4f(rgb, 1.0), state);
}

// Samples after which neighbouring rays, one of which may wait at a visible sample, are together again.
const STRETCH: u32 = 16u;
