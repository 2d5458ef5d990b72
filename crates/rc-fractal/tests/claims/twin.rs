//! Twins of height maps.

use rc_core::{Field, Grid, HeightField};
use rc_fractal::{SpectrumParams, Twin, TwinParams, height_and_slope_of_grid, radial_spectrum};

use crate::{assert_close, surface};

/// A map with a heavy upper tail.
fn map() -> Field {
    let heights = surface(SpectrumParams { roll_off: 4.0, ..SpectrumParams::paper(20, 7) });
    let grid = Grid::in_cell(96, 80, 1.0).expect("a grid");
    Field::from_fn(grid, |at| (heights.height(at) / 1.3e-3 * 0.5).exp())
}

fn params(map: &Field) -> TwinParams {
    TwinParams { grid: map.grid(), sides: [1.0; 2], has_heights_of_map: true, seed: 1 }
}

fn sorted(field: &Field) -> Vec<f64> {
    let mut values = field.values().to_vec();
    values.sort_by(f64::total_cmp);
    values
}

#[test]
fn a_twin_has_the_heights_of_its_map_exactly_and_its_spectrum_nearly() {
    let map = map();
    let twin = Twin::of(&map, &map, &params(&map));
    assert_eq!(sorted(&twin.heights), sorted(&map));
    assert!(twin.spectrum_deviation < 0.05, "{}", twin.spectrum_deviation);
    assert_close("rms slope", height_and_slope_of_grid(&twin.heights)[1], height_and_slope_of_grid(&map)[1], 0.02);
    for (of_twin, of_map) in radial_spectrum(&twin.heights).iter().zip(radial_spectrum(&map)).take(24) {
        assert_close(&format!("C({})", of_map.wavenumber), of_twin.psd, of_map.psd, 0.06);
    }
    let other = Twin::of(&map, &map, &TwinParams { seed: 2, ..params(&map) });
    let differ =
        other.heights.values().iter().zip(twin.heights.values()).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
    assert!(differ > map.grid().len() * 9 / 10, "seeds share heights");
}

/// Summits of the map are ten times as rough as valleys, which neither its spectrum nor its heights tell.
#[test]
fn a_twin_is_rough_where_the_map_is() {
    let (long, short) = (SpectrumParams::paper(6, 3), SpectrumParams { low_cut: 24.0, ..SpectrumParams::paper(40, 4) });
    let (long, short) = (surface(long), surface(short));
    let grid = Grid::square(192).expect("a grid");
    let map = Field::from_fn(grid, |at| {
        let height = long.height(at) / 1.3e-3;
        height + 0.1 * (1.0 + 0.9 * (2.0 * height).tanh()) * short.height(at) / 1.3e-3
    });
    let twin = Twin::of(&map, &map, &params(&map));
    let ratio = |field: &Field| {
        let (heights, n) = (sorted(field), grid.nx());
        let [valley, summit] = [0.15, 0.85].map(|part| heights[(part * grid.len() as f64) as usize]);
        let mut sums = [[0.0; 2]; 2];
        for (i, height) in field.values().iter().enumerate() {
            let right = field.values()[i - i % n + (i + 1) % n];
            let class = usize::from(*height >= valley);
            if *height < valley || *height > summit {
                sums[class] = [sums[class][0] + (right - height).powi(2), sums[class][1] + 1.0];
            }
        }
        (sums[1][0] / sums[1][1] / (sums[0][0] / sums[0][1])).sqrt()
    };
    assert!(ratio(&map) > 2.0, "the map has {}", ratio(&map));
    assert_close("ratio of slopes on summits and in valleys", ratio(&twin.heights), ratio(&map), 0.2);
}

#[test]
fn a_gaussian_twin_has_the_spectrum_exactly() {
    let map = map();
    let twin = Twin::of(&map, &map, &TwinParams { has_heights_of_map: false, ..params(&map) });
    assert!(twin.spectrum_deviation < 1e-10, "{}", twin.spectrum_deviation);
    assert_close("mean", twin.heights.mean(), map.mean(), 1e-12);
    let third = |field: &Field| {
        let mean = field.mean();
        let moment =
            |n: i32| field.values().iter().map(|h| (h - mean).powi(n)).sum::<f64>() / field.grid().len() as f64;
        moment(3) / moment(2).powf(1.5)
    };
    assert!(third(&map) > 1.0 && third(&twin.heights).abs() < 0.3, "{} and {}", third(&map), third(&twin.heights));
}

/// On a finer grid and in a larger cell the twin has the same heights and slopes.
#[test]
fn a_twin_on_another_grid_has_the_same_statistics() {
    let map = map();
    let slope = height_and_slope_of_grid(&map)[1];
    let [rms, _] = height_and_slope_of_grid(&map);
    let of = |nx, ny, sides| {
        let grid = Grid::new(nx, ny).expect("a grid");
        let twin = Twin::of(&map, &map, &TwinParams { grid, sides, ..params(&map) });
        let [height, slope] = height_and_slope_of_grid(&twin.heights);
        [height, slope / sides[0]]
    };
    for (name, [height, of_twin]) in [("finer", of(192, 160, [1.0; 2])), ("larger", of(192, 160, [2.0; 2]))] {
        assert_close(&format!("{name}: rms height"), height, rms, 0.02);
        assert_close(&format!("{name}: rms slope"), of_twin, slope, 0.1);
    }
}
