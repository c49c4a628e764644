// The eyes' pictures over the background: one, side by side, or as an anaglyph.

struct Show {
    background: vec3f,
    // Left and top, width and height of the area in the window, pixels.
    area: vec4f,
}

@group(0) @binding(0) var<uniform> show: Show;
@group(0) @binding(1) var left_eye: texture_2d<f32>;
@group(0) @binding(2) var right_eye: texture_2d<f32>;
@group(0) @binding(3) var interpolated: sampler;

@vertex
fn everywhere(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// The colour at a place of a picture (0 to 1), over the background.
fn color_at(picture: texture_2d<f32>, place: vec2f) -> vec3f {
    let color = textureSampleLevel(picture, interpolated, place, 0.0);
    return color.rgb + (1.0 - color.a) * show.background;
}

fn place_of(pixel: vec4f) -> vec2f {
    return (pixel.xy - show.area.xy) / show.area.zw;
}

@fragment
fn mono(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return vec4f(color_at(left_eye, place_of(pixel)), 1.0);
}

@fragment
fn side_by_side(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let place = place_of(pixel);
    let left = color_at(left_eye, vec2f(2.0 * place.x, place.y));
    let right = color_at(right_eye, vec2f(2.0 * place.x - 1.0, place.y));
    return vec4f(select(right, left, place.x < 0.5), 1.0);
}

// Dubois' matrices, as `RgbImage::anaglyph` has them.
@fragment
fn anaglyph(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let place = place_of(pixel);
    let from_left = mat3x3f(0.456, -0.040, -0.015, 0.500, -0.038, -0.021, 0.176, -0.016, -0.005);
    let from_right = mat3x3f(-0.043, 0.378, -0.072, -0.088, 0.734, -0.113, -0.002, -0.018, 1.226);
    return vec4f(from_left * color_at(left_eye, place) + from_right * color_at(right_eye, place), 1.0);
}
