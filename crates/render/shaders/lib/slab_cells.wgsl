// Cells of slabs of depth: `core::lightfield::anchors::SlabPicture`.
//
// A picture's buffer begins with two words of bits for each square of 8 x 8 pixels, row by row: the slabs in which it has cells that are
// not clear. Cells follow slab by slab from the front, in stacks of four rows: those of a column of a stack are next to each other, for
// software Vulkan takes about as long to load one word as four.

// Side of a square that bits are for, pixels.
const SLAB_SQUARE: u32 = 8u;

// Rows of a stack.
const STACK_ROWS: u32 = 4u;

const SLABS_PER_WORD: u32 = 32u;

const CLEAR_CELL: u32 = 0u;

// The first cell that is neither clear nor behind what its ray has ended in: below, six bits each for the number of the slab after that
// (`core::lightfield::anchors::Hider`), its blue, green and red.
const LEAST_KNOWN_CELL: u32 = 0x1000000u;

// Squares along x and y of a picture.
fn slab_squares(size: vec2u) -> vec2u {
    return (size + SLAB_SQUARE - 1u) / SLAB_SQUARE;
}

// The first stack of a slab, counted from the buffer's begin.
fn first_stack(size: vec2u, slab: u32, stack_row: u32) -> u32 {
    let squares = slab_squares(size);
    let stacks_of_bits = (2u * squares.x * squares.y + STACK_ROWS - 1u) / STACK_ROWS;
    let stack_rows = (size.y + STACK_ROWS - 1u) / STACK_ROWS;
    return stacks_of_bits + (slab * stack_rows + stack_row) * size.x;
}
