//! `rc sweep --list`: the shards of a sweep as command lines.
//!
//! Other programs run such lists of commands.

use std::ffi::OsString;
use std::path::Path;

use rc_sweep::Shard;

use super::part::folder_of;
use crate::error::CliError;
use crate::terminal;

/// Flags with a value that each command sets itself.
const WITH_VALUE: [&str; 2] = ["--out", "--shard"];

/// Flags that the commands do not have or set themselves.
const WITHOUT: [&str; 2] = ["--list", "--resume"];

/// Prints the command of each of `count` shards, one per line.
///
/// # Errors
/// [`CliError`] when an argument is not text, or when nothing can be printed.
pub(super) fn print(words: impl IntoIterator<Item = OsString>, count: usize, out: &Path) -> Result<(), CliError> {
    let words = words.into_iter().map(OsString::into_string).collect::<Result<Vec<_>, _>>();
    let refuse = |word: OsString| CliError::input(format_args!("list: '{}' is not text in UTF-8", word.display()));
    let words = kept(words.map_err(refuse)?);
    let lines = (1..=count).map(|index| line(&words, Shard { index, count }, out));
    terminal::print(&lines.collect::<String>())
}

/// The arguments without the flags that each command sets itself.
fn kept(words: Vec<String>) -> Vec<String> {
    let mut kept = Vec::new();
    let mut words = words.into_iter();
    while let Some(word) = words.next() {
        let flag = word.split_once('=').map_or(word.as_str(), |(flag, _)| flag);
        if WITH_VALUE.contains(&flag) {
            if flag == word {
                words.next();
            }
        } else if !WITHOUT.contains(&flag) {
            kept.push(word);
        }
    }
    kept
}

fn line(words: &[String], shard: Shard, out: &Path) -> String {
    let folder = folder_of(out, shard).to_string_lossy().into_owned();
    let own = ["--resume".to_owned(), "--shard".to_owned(), shard.to_string(), "--out".to_owned(), folder];
    words.iter().chain(&own).map(|word| quoted(word)).collect::<Vec<_>>().join(" ") + "\n"
}

/// `word` quoted for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_its_own_shard_and_folder_and_every_other_word() {
        let words = "rc sweep a.toml --list=2 --pressures 1e4:1e6:8 --out=old --seeds 1..3 --resume --quiet";
        let mut words: Vec<String> = words.split(' ').map(Into::into).collect();
        words.push("it's here.toml".into());
        let kept = kept(words);
        let expected = r"rc sweep a.toml --pressures 1e4:1e6:8 --seeds 1..3 --quiet 'it'\''s here.toml' --resume --shard 2/2 --out 'my parts/part-2-of-2'";
        assert_eq!(line(&kept, Shard { index: 2, count: 2 }, Path::new("my parts")).trim_end(), expected);
    }
}
