//! Scenes laid over each other.

use super::*;

#[test]
fn an_upper_key_removes_its_alternatives_below() {
    let lower = Scene {
        surface: SurfaceKeys { waves: Some(8), rms: Some(1.0), cell: Some(2.0), ..Default::default() },
        contact: ContactKeys { pressure: Some(1.0), e_star: Some(3.0), ..Default::default() },
        run: RunKeys::default(),
    };
    let upper = Scene {
        surface: SurfaceKeys { c0: Some(4.0), ..Default::default() },
        contact: ContactKeys { penetration: Some(5.0), young: Some(6.0), ..Default::default() },
        run: RunKeys { json: true, ..Default::default() },
    };
    let merged = upper.over(lower);
    assert_eq!((merged.surface.c0, merged.surface.rms, merged.surface.waves), (Some(4.0), None, Some(8)));
    assert_eq!((merged.contact.penetration, merged.contact.pressure), (Some(5.0), None));
    assert_eq!((merged.contact.young, merged.contact.e_star), (Some(6.0), None));
    assert!(merged.run.json);
}

#[test]
fn a_height_map_replaces_a_random_surface_and_the_reverse() {
    let map = SurfaceKeys { heights: Some("h.npy".into()), ..Default::default() };
    let random =
        SurfaceKeys { waves: Some(8), grid: Some(GridSpec::square(64)), cell: Some(2.0), ..Default::default() };
    let merged = map.clone().over(random.clone());
    assert_eq!((merged.waves, merged.grid, merged.cell), (None, None, Some(2.0)));
    let rectangle = || SurfaceKeys { cell: Some(2.0), cell_y: Some(1.0), ..Default::default() };
    let other = SurfaceKeys { cell: Some(4.0), ..Default::default() }.over(rectangle());
    assert_eq!((other.cell, other.cell_y), (Some(4.0), None), "the other side was that of another cell");
    let same = SurfaceKeys { grid: Some(GridSpec::square(64)), ..Default::default() }.over(rectangle());
    assert_eq!((same.cell, same.cell_y), (Some(2.0), Some(1.0)));
    assert_eq!(random.clone().over(map.clone()).heights, None);
    let waves = SurfaceKeys { spectrum: Some("waves.txt".into()), ..Default::default() };
    for lower in [&random, &map] {
        let merged = waves.clone().over(lower.clone());
        assert_eq!((merged.waves, merged.heights, merged.cell), (None, None, lower.cell));
        assert_eq!(lower.clone().over(waves.clone()).spectrum, None);
    }
    // A seed alone is another realisation of a measured spectrum, and not a self-affine surface.
    let measured = SurfaceKeys { psd: Some("psd.csv".into()), cell: Some(2.0), seed: Some(1), ..Default::default() };
    let seeded = SurfaceKeys { seed: Some(7), ..Default::default() }.over(measured.clone());
    assert_eq!((seeded.psd, seeded.seed, seeded.cell), (measured.psd.clone(), Some(7), Some(2.0)));
    assert_eq!(random.over(measured.clone()).psd, None);
    // What is added stays on a measured spectrum or a twin.
    let formed = SurfaceKeys { shape: Some(FormName::Flat), add: Some("b.npy".into()), waves: Some(8), ..rectangle() };
    let twin = SurfaceKeys { like: Some("h.npy".into()), ..Default::default() };
    for (upper, cell_y) in [(measured, None), (twin, Some(1.0))] {
        let merged = upper.over(formed.clone());
        assert_eq!((merged.shape, merged.add, merged.waves), (formed.shape, formed.add.clone(), None));
        assert_eq!(merged.cell_y, cell_y);
    }
}
