// What pictures saw first, by tiles: `core::first_hits`.

// Pixels along each side of a tile.
const HIT_TILE: u32 = 8u;

// Further away than anything.
const NOWHERE_M: f32 = 1e30;

const SIGN: u32 = 0x80000000u;

// A number above 0 for a depth in metres, the larger the nearer.
fn nearness_of(depth_m: f32) -> u32 {
    let bits = bitcast<u32>(-depth_m);
    return select(bits | SIGN, ~bits, (bits & SIGN) != 0u);
}

// The depth of such a number, metres; that of 0 is `NOWHERE_M`.
fn depth_of(nearness: u32) -> f32 {
    let bits = select(~nearness, nearness & ~SIGN, (nearness & SIGN) != 0u);
    return select(-bitcast<f32>(bits), NOWHERE_M, nearness == 0u);
}
