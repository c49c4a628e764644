// Samples [begin, end) of a ray that may contribute, and the reads of a map that finding them took.
struct Run {
    begin: u32,
    end: u32,
    map_reads: u32,
}
