// Cells of slabs of depth: `core::lightfield::anchors::SlabPicture`.
//
// A picture's buffer begins with two words of bits for each square of 8 x 8 pixels, row by row: the slabs in which it has cells that are
// not clear. Planes of words follow: what hides the last slabs of each pixel, then the cells of each slab from the front. Planes are in
// stacks of four rows: the words of a column of a stack are next to each other, for software Vulkan takes about as long to load one word
// as four.

// Side of a square that bits are for, pixels.
const SLAB_SQUARE: u32 = 8u;

// Rows of a stack.
const STACK_ROWS: u32 = 4u;

const SLABS_PER_WORD: u32 = 32u;

const CLEAR_CELL: u32 = 0u;

// Bits below the number of the slab after that in which something hides what is behind, and its blue, green and red of six bits each:
// `core::lightfield::anchors::Hider`. Zero if nothing does.
const HIDER_SHIFT: u32 = 18u;

const HIDER_STEPS: f32 = 63.0;

// Squares along x and y of a picture.
fn slab_squares(size: vec2u) -> vec2u {
    return (size + SLAB_SQUARE - 1u) / SLAB_SQUARE;
}

// Words before the planes: they begin where a binding may.
fn words_of_bits(size: vec2u) -> u32 {
    let squares = slab_squares(size);
    return (2u * squares.x * squares.y + 63u) / 64u * 64u;
}

// The first stack of a row of stacks of a plane, counted from the first plane.
fn stack_of_plane(size: vec2u, plane: u32, stack_row: u32) -> u32 {
    let stack_rows = (size.y + STACK_ROWS - 1u) / STACK_ROWS;
    return (plane * stack_rows + stack_row) * size.x;
}

// The first stack of what hides the last slabs.
fn stack_of_ends(size: vec2u, stack_row: u32) -> u32 {
    return stack_of_plane(size, 0u, stack_row);
}

// The first stack of cells of a slab.
fn stack_of_cells(size: vec2u, slab: u32, stack_row: u32) -> u32 {
    return stack_of_plane(size, slab + 1u, stack_row);
}

// The bit of a slab in the two words of a square.
fn slab_bit(slab: u32) -> vec2u {
    let bit = 1u << (slab % SLABS_PER_WORD);
    return select(vec2u(bit, 0u), vec2u(0u, bit), slab >= SLABS_PER_WORD);
}
