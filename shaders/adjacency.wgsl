// One invocation a pixel: ink where a neighbour at least as far shows a facet that shares no lattice edge (or no
// corner) with the pixel's own. Mower 2015, algorithm 1. Fewest lattice vertices two facets must share:
override shared_vertices: u32 = 2u;

@group(0) @binding(22) var<storage, read_write> out_ink: array<u32>;

fn shares(f: Facet, g: Facet) -> u32 {
    return is_of(f.a, g) + is_of(f.b, g) + is_of(f.c, g);
}

fn is_of(vertex: vec2<u32>, f: Facet) -> u32 {
    return select(0u, 1u, all(vertex == f.a) || all(vertex == f.b) || all(vertex == f.c));
}

// Whether a lattice vertex lies on the border of the DEM or of a void: whether a patch around it is missing.
fn on_rim(at: vec2<u32>) -> bool {
    let sub = at % CELL_STEPS;
    let c = i32(at.x / CELL_STEPS);
    let r = i32(at.y / CELL_STEPS);
    if all(sub == vec2<u32>(0u)) {
        return !(patch_exists(c, r, 0u) && patch_exists(c, r, 1u) && patch_exists(c, r - 1, 0u)
            && patch_exists(c - 1, r, 1u) && patch_exists(c - 1, r - 1, 0u) && patch_exists(c - 1, r - 1, 1u));
    }
    if sub.y == 0u {
        return !(patch_exists(c, r, 1u) && patch_exists(c, r - 1, 0u));
    }
    if sub.x == 0u {
        return !(patch_exists(c, r, 0u) && patch_exists(c - 1, r, 1u));
    }
    return sub.x == sub.y && !(patch_exists(c, r, 0u) && patch_exists(c, r, 1u));
}

fn touches_rim(f: Facet) -> bool {
    return on_rim(f.a) || on_rim(f.b) || on_rim(f.c);
}

@compute @workgroup_size(64)
fn adjacency(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let at = vec2<i32>(invocation.xy);
    if !on_page(at) {
        return;
    }
    let i = pixel_index(at);
    out_ink[i] = 0u;
    let p = pixels[i];
    if p.y == 0u || is_away(p.x - 1u) {
        return;
    }
    let facet = facet_of(p.x - 1u);
    var inked = false;
    for (var k = 0u; k < 8u && !inked; k++) {
        let to = at + neighbour(k);
        if !on_page(to) {
            continue;
        }
        let q = pixels[pixel_index(to)];
        if q.y > p.y || q.x == p.x {
            continue;
        }
        if q.y == 0u || is_away(q.x - 1u) {
            inked = !touches_rim(facet);
        } else {
            inked = shares(facet, facet_of(q.x - 1u)) < shared_vertices;
        }
    }
    if inked {
        out_ink[i] = SILHOUETTE;
    }
}
