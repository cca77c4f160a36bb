//! What the builders take while they work, counted at the allocator.

#![allow(clippy::unwrap_used, clippy::expect_used, unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use halfshade::bvh::{Builder, Bvh};
use halfshade::math::Vec3;

struct Counting;

static NOW: AtomicU64 = AtomicU64::new(0);
static PEAK: AtomicU64 = AtomicU64::new(0);

// SAFETY: every call is passed on to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size() as u64, Relaxed) + layout.size() as u64;
        PEAK.fetch_max(now, Relaxed);
        // SAFETY: the caller's promises are those that the system's allocator wants.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size() as u64, Relaxed);
        // SAFETY: as above; `pointer` came from `System`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

/// `2 * side²` triangles; with `gap`, each by itself.
fn sheet(side: u32, gap: f32) -> Mesh {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
        let corner = |di: u32, dj: u32, shrink: f32| {
            let at = |i: u32, d: u32| (i as f32 + 0.5 + (d as f32 - 0.5) * shrink) / side as f32;
            let (x, y) = (at(i, di), at(j, dj));
            Vec3::new(x, y, 0.1 * (9.0 * x).sin() * (7.0 * y).cos())
        };
        let shrink = 1.0 - gap;
        let first = positions.len() as u32;
        positions.extend([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(a, b)| corner(a, b, shrink)));
        indices.extend([
            [first, first + 1, first + 2],
            [first + 1, first + 3, first + 2],
        ]);
    }
    (positions, indices)
}

/// Every hundredth triangle across everything else.
fn mixed(side: u32) -> Mesh {
    let (mut positions, mut indices) = sheet(side, 0.3);
    for i in (0..indices.len()).step_by(100) {
        let first = positions.len() as u32;
        let x = i as f32 / indices.len() as f32;
        positions.extend([
            Vec3::new(x, 0.0, -1.0),
            Vec3::new(x, 1.0, 0.0),
            Vec3::new(1.0, x, 1.0),
        ]);
        indices[i] = [first, first + 1, first + 2];
    }
    (positions, indices)
}

/// One test, so that no other allocates meanwhile.
#[test]
fn builds_stay_within_what_they_announce() {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    for (positions, indices) in [sheet(10, 0.0), sheet(300, 0.0), sheet(300, 0.4), mixed(250)] {
        let triangles = indices.len() as u64;
        for builder in Builder::ALL {
            let before = NOW.load(Relaxed);
            PEAK.store(before, Relaxed);
            let tree = pool.install(|| Bvh::build(&positions, &indices, builder));
            let peak = PEAK.load(Relaxed) - before;
            let bytes = tree.memory_bytes() as u64;
            let each = |bytes: u64| bytes as f64 / triangles as f64;
            println!(
                "{builder}, {triangles}: {:.1} bytes a triangle, {:.1} at the peak",
                each(bytes),
                each(peak)
            );
            assert!(
                peak <= builder.peak_bytes(triangles),
                "{builder}, {triangles}: {peak}"
            );
            assert!(
                bytes <= builder.tree_bytes(triangles),
                "{builder}, {triangles}: {bytes}"
            );
            // An estimate that is far too high would refuse what can be done.
            assert!(
                triangles < 100_000 || 2 * peak > builder.peak_bytes(triangles),
                "{builder}: {peak}"
            );
        }
    }
}
