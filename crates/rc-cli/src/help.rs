//! Pages of help: the flag that prints one, and the order of its headings.

use clap::{Arg, ArgAction, Command};

pub(crate) const SURFACE: &str = "Surface";
pub(crate) const CONTACT: &str = "Contact";
pub(crate) const ACCURACY: &str = "Accuracy";
pub(crate) const RESULTS: &str = "Results";
pub(crate) const FILES: &str = "Surface from a file";
pub(crate) const RANDOM: &str = "Random surface";
pub(crate) const PHYSICS: &str = "Physics beyond the elastic half-space";
pub(crate) const MACHINE: &str = "Method and machine";

const ORDER: [&str; 8] = [SURFACE, CONTACT, ACCURACY, RESULTS, FILES, RANDOM, PHYSICS, MACHINE];

/// `-h` and `--help` print the same short page; manual pages have the long texts.
pub(crate) fn help_flag() -> Arg {
    Arg::new("help")
        .short('h')
        .long("help")
        .action(ArgAction::HelpShort)
        .global(true)
        .display_order(900)
        .help("Print help")
}

/// Hides the keys of a shear, which only a single solve has.
pub(crate) fn without_shear(arg: Arg) -> Arg {
    const KEYS: [&str; 5] = ["friction", "shear_pressure", "shear_displacement", "shear_angle", "uncoupled"];
    let is_hidden = KEYS.contains(&arg.get_id().as_str());
    if is_hidden { arg.hide(true) } else { arg }
}

/// Adds the arguments of `group` to `command`, heading by heading.
///
/// Clap prints headings in the order of their first arguments. For keys that is the order of scene files.
pub(crate) fn add_by_heading(command: Command, group: &Command) -> Command {
    let mut arguments: Vec<Arg> = group.get_arguments().cloned().collect();
    arguments.sort_by_key(|argument| ORDER.iter().position(|heading| argument.get_help_heading() == Some(heading)));
    command.args(arguments)
}
