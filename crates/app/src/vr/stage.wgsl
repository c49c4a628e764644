// What an eye sees of the room: lines behind the volume, its picture, lines in front of it.

struct Stage {
    clip_from_room: mat4x4f,
    // Width and height of the image, pixels.
    size_px: vec2f,
    // Width of lines, pixels.
    line_px: f32,
    // Nearest depth of the eye's frustum, metres.
    near_m: f32,
}

@group(0) @binding(0) var<uniform> stage: Stage;
// Premultiplied.
@group(0) @binding(1) var picture: texture_2d<f32>;
@group(0) @binding(2) var interpolated: sampler;
// Of the picture, near over depth.
@group(0) @binding(3) var depths: texture_2d<f32>;

// Least depth that lines are drawn at, metres.
const NEAR_M: f32 = 0.01;

@vertex
fn everywhere(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn show_picture(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return textureSampleLevel(picture, interpolated, pixel.xy / stage.size_px, 0.0);
}

struct Depth {
    // Is not written.
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn keep_depth(@builtin(position) pixel: vec4f) -> Depth {
    let at = pixel.xy / stage.size_px * vec2f(textureDimensions(depths));
    return Depth(vec4f(0.0), textureLoad(depths, vec2i(at), 0).x);
}

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) color: vec4f,
}

// A line as two triangles. Ends are points in the room and their opacity.
@vertex
fn line_corner(
    @builtin(vertex_index) corner: u32,
    @location(0) begin: vec4f,
    @location(1) finish: vec4f,
    @location(2) rgb: vec3f,
) -> Corner {
    let ends = array(stage.clip_from_room * vec4f(begin.xyz, 1.0), stage.clip_from_room * vec4f(finish.xyz, 1.0));
    let a = before_eye(ends[0], ends[1]);
    let b = before_eye(ends[1], ends[0]);
    let along = (b.xy / b.w - a.xy / a.w) * stage.size_px;
    let across = vec2f(-along.y, along.x) / max(length(along), 1e-6) * stage.line_px / stage.size_px;
    // Begin left, begin right, end left, end right.
    var numbers = array(0u, 1u, 2u, 2u, 1u, 3u);
    let number = numbers[corner];
    let is_end = number >= 2u;
    let side = select(-1.0, 1.0, (number & 1u) == 1u);
    let end = select(a, b, is_end);
    let is_visible = ends[0].w > NEAR_M || ends[1].w > NEAR_M;
    let position = vec4f(end.xy + side * across * end.w, min(stage.near_m, end.w), select(0.0, end.w, is_visible));
    let alpha = select(begin.w, finish.w, is_end);
    return Corner(position, vec4f(rgb * alpha, alpha));
}

// An end, or where the line to the other one comes before the eye.
fn before_eye(end: vec4f, other: vec4f) -> vec4f {
    let share = clamp((NEAR_M - end.w) / (other.w - end.w), 0.0, 1.0);
    return select(end, mix(end, other, share), end.w < NEAR_M && other.w > end.w);
}

@fragment
fn line(corner: Corner) -> @location(0) vec4f {
    return corner.color;
}
