// The views of a light-field display: side by side, as an eye sees them, or interlaced for a panel.

struct Tiles {
    background: vec3f,
    views: u32,
    // Left and top, width and height of the area in the window, pixels.
    area: vec4f,
    // Width and height of a view side by side, pixels.
    tile: vec2u,
    // Columns and rows of views.
    grid: vec2u,
    // Width and height of a panel, pixels.
    panel: vec2u,
    // Whether the first row of views is the lowest; whether a panel exchanges left and right, top and bottom.
    begins_below: u32,
    flips_x: u32,
    flips_y: u32,
}

// A view that is seen in a column of the picture, as `core::lightfield::simulator::SeenView`.
struct Seen {
    view: u32,
    weight: f32,
    along: f32,
    top: f32,
    bottom: f32,
}

@group(0) @binding(0) var<uniform> tiles: Tiles;
@group(0) @binding(1) var views: texture_2d_array<f32>;
@group(0) @binding(2) var interpolated: sampler;
// Where the views of each column begin, and where those of the last end.
@group(0) @binding(3) var<storage, read> columns: array<u32>;
@group(0) @binding(4) var<storage, read> seen: array<Seen>;
// The views that red, green and blue of each pixel of a panel show.
@group(0) @binding(5) var shown: texture_2d<u32>;

// Weight in all up to which there is no light: `core::lightfield::simulator::DARK`.
const DARK = 1e-3;

fn over_background(color: vec4f) -> vec3f {
    return color.rgb + (1.0 - color.a) * tiles.background;
}

// A pixel of a view, counted in those of the panel or of the quilt.
fn pixel_of(view: u32, place: vec2u, size: vec2u) -> vec3f {
    let texel = (2u * place + 1u) * textureDimensions(views) / (2u * size);
    return over_background(textureLoad(views, texel, view, 0));
}

@fragment
fn quilt(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let place = vec2u(pixel.xy - tiles.area.xy);
    let cell = place / tiles.tile;
    let row = select(cell.y, tiles.grid.y - 1u - cell.y, tiles.begins_below != 0u);
    let view = row * tiles.grid.x + cell.x;
    if any(cell >= tiles.grid) || view >= tiles.views {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    return vec4f(pixel_of(view, place % tiles.tile, tiles.tile), 1.0);
}

@fragment
fn light_field(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let column = u32(pixel.x - tiles.area.x);
    let share = (pixel.y - tiles.area.y) / tiles.area.w;
    var sum = vec3f();
    var weight = 0.0;
    for (var i = columns[column]; i < columns[column + 1u]; i += 1u) {
        let view = seen[i];
        let down = mix(view.top, view.bottom, share);
        if down >= 0.0 && down <= 1.0 {
            let color = textureSampleLevel(views, interpolated, vec2f(view.along, down), view.view, 0.0);
            sum += view.weight * over_background(color);
            weight += view.weight;
        }
    }
    return vec4f(select(vec3f(), sum / weight, weight > DARK), 1.0);
}

// As `Lenticular::interlace`.
@fragment
fn panel(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let place = vec2u(pixel.xy - tiles.area.xy);
    let flipped = tiles.panel - 1u - place;
    let unflipped =
        vec2u(select(place.x, flipped.x, tiles.flips_x != 0u), select(place.y, flipped.y, tiles.flips_y != 0u));
    let of_channels = textureLoad(shown, place, 0);
    let red = pixel_of(of_channels.r, unflipped, tiles.panel).r;
    let green = pixel_of(of_channels.g, unflipped, tiles.panel).g;
    let blue = pixel_of(of_channels.b, unflipped, tiles.panel).b;
    return vec4f(red, green, blue, 1.0);
}
