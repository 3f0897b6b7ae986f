// What is counted of curves: each may be more than there is room for.

struct Tally {
    wanted: atomic<u32>,    // chunks
    crossed: atomic<u32>,   // facets
    segments: atomic<u32>,
    asked: atomic<u32>,     // segments that are looked at
    cut_short: atomic<u32>, // walks that a driver ended before they were done: must be 0
}
