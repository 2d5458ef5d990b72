//! Errors over ranks: an error on one rank is an error on all.

use rc_comm::Ranks;

use crate::error::CliError;

/// The result of this rank, or the error of the first rank that has one.
///
/// All ranks call this together.
///
/// # Errors
/// The error of that rank.
pub(crate) fn together<T>(ranks: &Ranks, result: Result<T, CliError>) -> Result<T, CliError> {
    if ranks.are_alone() {
        return result;
    }
    let mine = match &result {
        Ok(_) => Vec::new(),
        Err(error) => [&[error.exit_code()], error.to_string().as_bytes()].concat(),
    };
    match ranks.all_gather(&mine).into_iter().find(|error| !error.is_empty()) {
        None => result,
        Some(error) => Err(CliError::of_code(error[0], String::from_utf8_lossy(&error[1..]).into_owned())),
    }
}

#[cfg(test)]
mod tests {
    use rc_comm::run_threads;

    use super::*;

    #[test]
    fn an_error_of_one_rank_is_that_of_all() {
        let of_rank = |ranks: Ranks| {
            let result = if ranks.rank() == 1 { Err(CliError::Write("disk full".into())) } else { Ok(ranks.rank()) };
            together(&ranks, result)
        };
        let results = run_threads(3, of_rank).expect("all ranks end");
        assert_eq!(results, vec![Err(CliError::Write("disk full".into())); 3]);
        let fine = run_threads(2, |ranks| together(&ranks, Ok(ranks.rank()))).expect("all ranks end");
        assert_eq!(fine, [Ok(0), Ok(1)]);
    }
}
