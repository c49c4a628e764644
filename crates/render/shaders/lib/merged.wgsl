import package::lib::cuts::{is_cut_at};
import package::lib::join::{color_of, join};
import package::lib::mirrored::{mirrored};
import package::lib::ray_state::{FIRST_HIT_ALPHA, NOTHING_HIT, Pixel};
import package::lib::strips::{first_reached, partial_at, partial_depths_m, partials, reach};
import package::lib::view::{view};

// A derived pixel from what the strips have left for it, the last strip in front.
struct Merged {
    pixel: Pixel,
    // Whether rays ended that it would have needed.
    is_cut: bool,
}

fn merged_at(at_pixel: vec2u) -> Merged {
    let column = mirrored(i32(at_pixel.x));
    let width = i32(view.pair.width);
    // Strips whose reach holds the column: first_reached(strip) <= column < first_reached(strip) + reach().
    let from_first = column - first_reached(0u);
    let last = select(-1, min(from_first / width, i32(view.pair.count) - 1), from_first >= 0);
    let first = max((from_first - i32(reach()) + width) / width, 0);
    var joint = vec4f(0.0);
    var depth_m = NOTHING_HIT;
    var is_cut = false;
    // Reads outside of branches: a branch around the loop crashes Mesa 22's software Vulkan.
    var strip = last;
    while strip >= first {
        let at = partial_at(at_pixel.y, u32(strip), column);
        let partial = partials[at];
        let partial_depth_m = partial_depths_m[at];
        is_cut |= is_cut_at(at_pixel.y, u32(strip), column);
        joint = join(joint, partial);
        if depth_m == NOTHING_HIT && joint.a >= FIRST_HIT_ALPHA {
            depth_m = partial_depth_m;
        }
        strip--;
    }
    return Merged(Pixel(color_of(joint), depth_m, 0u, 0u), is_cut);
}
