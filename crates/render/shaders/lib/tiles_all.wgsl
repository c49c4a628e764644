import package::lib::view::{BAND_ROWS, first_pixel_of_group};

// Every pixel of a piece.

// Invocations of a workgroup.
const LANES: u32 = BAND_ROWS * BAND_ROWS;

// The pixel of a lane. Every eight consecutive lanes are a rectangle of 4 x 2, whose rays stay closer together than those of
// a row.
fn pixel_of_lane(group: vec3u, lane: u32) -> vec2u {
    let in_square = vec2u(lane & 3u, (lane >> 2u) & 1u) + vec2u((lane >> 3u) & 1u, lane >> 4u) * vec2u(4u, 2u);
    return first_pixel_of_group(group) + in_square;
}

// Leaves a pixel as it is, blank, whose ray misses.
fn store_miss(pixel: vec2u) {}
