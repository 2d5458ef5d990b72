//! Keys that a surface from a file or a shape needs.
//!
//! The example's size and material belong to another surface.

use crate::error::CliError;
use crate::scene::keys::{ContactKeys, SurfaceKeys};

/// Refuses a surface from a file without a size.
///
/// The keys or a file of a format with sizes must give it.
///
/// # Errors
/// [`CliError::Input`] with the missing key.
pub fn check_size(surface: &SurfaceKeys) -> Result<(), CliError> {
    check(surface, size(surface)?)
}

/// Refuses a surface from a file without a size or without a material.
///
/// # Errors
/// [`CliError::Input`] with the missing keys.
pub fn check_size_and_material(surface: &SurfaceKeys, contact: &ContactKeys) -> Result<(), CliError> {
    check(surface, size(surface)?.into_iter().chain(material(contact)))
}

/// Refuses a map outside a file without a size or without a material.
///
/// For such a map only the keys can give the size.
///
/// # Errors
/// [`CliError::Input`] with the missing keys.
pub fn check_cell_and_material(surface: &SurfaceKeys, contact: &ContactKeys) -> Result<(), CliError> {
    check(surface, surface.cell.is_none().then_some(CELL).into_iter().chain(material(contact)))
}

fn check(surface: &SurfaceKeys, missing: impl IntoIterator<Item = &'static str>) -> Result<(), CliError> {
    let missing: Vec<&str> = missing.into_iter().collect();
    let what = match surface.file() {
        Some(("spectrum", _)) => "spectrum: a file of waves",
        Some(("psd", _)) => "psd: a table of a spectrum",
        Some(("like", _)) => "like: a twin",
        Some(_) => "heights: a height map",
        None if surface.is_shape() => "shape: a shape alone",
        None => return Ok(()),
    };
    match &missing[..] {
        [_, ..] => Err(CliError::input(format_args!(
            "{what} needs {} too; the default values are for random surfaces only",
            missing.join(", and ")
        ))),
        _ => Ok(()),
    }
}

/// Key that a map without a size needs.
const CELL: &str = "cell (m)";

/// The missing key of the size.
///
/// For a file of a format with sizes, only reading it tells whether it has them.
fn size(surface: &SurfaceKeys) -> Result<Option<&'static str>, CliError> {
    let is_known = match &surface.heights {
        Some(path) => surface.cell.is_some() || rc_heights::may_have_sides(path, &surface.read_params())?,
        // The size of a twin is that of its map, which is read later.
        None => surface.cell.is_some() || surface.spectrum.is_none() && surface.psd.is_none() && !surface.is_shape(),
    };
    match &surface.heights {
        Some(path) if !is_known && rc_heights::has_profile(path, &surface.read_params())? => {
            Err(CliError::in_file(path, "a profile, not a map; give --line for the line contact of a profile"))
        }
        _ => Ok((!is_known).then_some(CELL)),
    }
}

/// The missing keys of the material.
fn material(contact: &ContactKeys) -> Option<&'static str> {
    match (contact.e_star, contact.young, contact.poisson) {
        (Some(_), ..) | (None, Some(_), Some(_)) => None,
        (None, None, None) => Some("e_star (Pa) or young (Pa) with poisson"),
        (None, Some(_), None) => Some("poisson"),
        (None, None, Some(_)) => Some("young (Pa)"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_named() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("map.csv");
        std::fs::write(&path, "1,2,3,4\n5,6,7,8\n").expect("a map without a size");
        let map = |cell| SurfaceKeys { heights: Some(path.clone()), cell, ..SurfaceKeys::default() };
        let material = |e_star, young, poisson| ContactKeys { young, poisson, e_star, ..ContactKeys::default() };
        let none = material(None, None, None);
        let all = "needs cell (m), and e_star (Pa) or young (Pa) with poisson too";
        let refused = [
            (map(None), none.clone(), all),
            (map(Some(1.0)), none.clone(), "needs e_star (Pa) or young (Pa) with poisson too"),
            (map(Some(1.0)), material(None, Some(1.0), None), "needs poisson too"),
            (map(Some(1.0)), material(None, None, Some(0.3)), "needs young (Pa) too"),
            (map(None), material(Some(1.0), None, None), "needs cell (m) too"),
        ];
        for (surface, contact, expected) in refused {
            let error = check_size_and_material(&surface, &contact).expect_err(expected).to_string();
            assert!(error.contains(expected), "{error}");
        }
        for material in [material(Some(1.0), None, None), material(None, Some(1.0), Some(0.3))] {
            check_size_and_material(&map(Some(1.0)), &material).expect("all that is needed");
        }
        let waves = SurfaceKeys { spectrum: Some("waves.txt".into()), ..SurfaceKeys::default() };
        let error = check_size_and_material(&waves, &none).expect_err("neither").to_string();
        assert!(error.starts_with("spectrum: a file of waves needs cell (m), and e_star (Pa)"), "{error}");
        check_size_and_material(&SurfaceKeys::default(), &none).expect("a generated surface");
        check_size(&map(Some(1.0))).expect("a size");
    }
}
