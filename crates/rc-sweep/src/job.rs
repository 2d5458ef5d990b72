//! The shard of a process, from variables of a job system or an MPI launcher.

use thiserror::Error;

use crate::shard::Shard;

/// Reasons why a process cannot determine its shard. Each message says what was found.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum JobError {
    /// The process was not started by a system that numbers its tasks.
    #[error("found neither a job array nor an MPI launcher: none of {} is set", NUMBERS.join(", "))]
    None,
    /// The value of a variable is not a number.
    #[error("{name} is '{value}', not a number")]
    NotANumber {
        /// Name of the variable.
        name: String,
        /// Value of the variable.
        value: String,
    },
    /// The number of the task is known, but the number of tasks is not.
    #[error("{found} does not say how many tasks there are")]
    NoCount {
        /// The variables with their values.
        found: String,
    },
    /// The numbers of an array have gaps, or contradict the size of the array.
    #[error(
        "the indices of the tasks are not evenly spaced, or their range does not match the number of tasks ({found})"
    )]
    Uneven {
        /// The variables with their values.
        found: String,
    },
    /// The task does not belong to the array.
    #[error("{found} is outside 1 to {count}")]
    Outside {
        /// The variable with its value.
        found: String,
        /// Number of shards.
        count: usize,
    },
    /// A batch script has tasks, but this process was not started as one of them.
    #[error("{found}, but srun did not start this process")]
    NotStarted {
        /// The variable with its value.
        found: String,
    },
    /// Two sources number the tasks differently.
    #[error("{one} contradicts {other}")]
    Contradiction {
        /// Variables of one source with their values.
        one: String,
        /// Variables of the other source with their values.
        other: String,
    },
}

/// The variables with the number of a task.
const NUMBERS: [&str; 7] = [
    "SLURM_ARRAY_TASK_ID",
    "PBS_ARRAY_INDEX",
    "PBS_ARRAYID",
    "OMPI_COMM_WORLD_RANK",
    "PMI_RANK",
    "PMIX_RANK",
    "SLURM_STEP_ID",
];

/// Variables of a job array of Slurm: id, first, last, number, step.
const SLURM_ARRAY: [&str; 5] = [
    "SLURM_ARRAY_TASK_ID",
    "SLURM_ARRAY_TASK_MIN",
    "SLURM_ARRAY_TASK_MAX",
    "SLURM_ARRAY_TASK_COUNT",
    "SLURM_ARRAY_TASK_STEP",
];

/// Indices of the arrays of PBS Pro and of Torque. The number of tasks is not available.
const PBS_ARRAYS: [&str; 2] = ["PBS_ARRAY_INDEX", "PBS_ARRAYID"];

/// Variables of rank and number of ranks: Open MPI; MPICH, Intel MPI and srun; PMIx.
const MPI: [(&str, &str); 3] =
    [("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"), ("PMI_RANK", "PMI_SIZE"), ("PMIX_RANK", "PMIX_SIZE")];

/// Variables of the tasks that srun starts. A batch script has SLURM_PROCID too, but no step.
const SLURM_STEP: [&str; 3] = ["SLURM_STEP_ID", "SLURM_PROCID", "SLURM_STEP_NUM_TASKS"];

/// The information of one source: task `number` of `count`, counted from `base`.
struct Claim {
    number: usize,
    base: usize,
    count: Option<usize>,
    found: String,
}

/// The environment of a job.
struct Job<'a>(&'a dyn Fn(&str) -> Option<String>);

impl Shard {
    /// The shard of this process, from its task in a job array or its rank.
    ///
    /// Job arrays are those of Slurm, PBS and Torque. Ranks are those of Open MPI, MPICH, Intel MPI, PMIx and srun. If
    /// `count` is given, it is the number of shards, and the tasks of arrays are numbered from 1 to `count`. Otherwise
    /// the job system must provide the number. `variable` returns the value of an environment variable.
    ///
    /// # Errors
    /// [`JobError`] when no system numbers the process, or when two sources contradict each other.
    pub fn of_job(count: Option<usize>, variable: &dyn Fn(&str) -> Option<String>) -> Result<Self, JobError> {
        let job = Job(variable);
        let array = job.array(count.is_none())?;
        let rank = match job.rank()? {
            Some(rank) => Some(rank),
            None => job.step(array.is_some())?,
        };
        // A source with one task does not divide the work.
        let divides = |claim: &Claim| claim.count != Some(1);
        let claim = match (array, rank) {
            (Some(array), Some(rank)) if divides(&array) && divides(&rank) => {
                return Err(JobError::Contradiction { one: array.found, other: rank.found });
            }
            (Some(array), Some(rank)) => {
                if divides(&rank) {
                    rank
                } else {
                    array
                }
            }
            (one, other) => one.or(other).ok_or(JobError::None)?,
        };
        claim.shard(count)
    }
}

impl Claim {
    /// The shard, of `count` shards if `count` is given.
    fn shard(self, count: Option<usize>) -> Result<Shard, JobError> {
        let Self { number, base, count: own, found } = self;
        match (own, count) {
            // A part of an array may have been submitted again. Ranks are always complete.
            (Some(own), Some(count)) if own != count && base == 0 => {
                Err(JobError::Contradiction { one: format!("auto/{count}"), other: found })
            }
            (None, None) => Err(JobError::NoCount { found }),
            (own, given) => {
                let count = given.or(own).unwrap_or(1);
                // The base is 0 or 1.
                let index = number.saturating_add(1 - base);
                if (1..=count).contains(&index) {
                    Ok(Shard { index, count })
                } else {
                    Err(JobError::Outside { found, count })
                }
            }
        }
    }
}

impl Job<'_> {
    fn number(&self, name: &str) -> Result<Option<usize>, JobError> {
        let Some(value) = (self.0)(name).filter(|value| !value.trim().is_empty()) else { return Ok(None) };
        let number = value.trim().parse().map(Some);
        number.map_err(|_| JobError::NotANumber { name: name.to_owned(), value })
    }

    /// The variables that are set, as `A=1, B=2`.
    fn found(&self, names: &[&str]) -> String {
        let set = names.iter().filter_map(|name| Some(format!("{name}={}", (self.0)(name)?)));
        set.collect::<Vec<_>>().join(", ")
    }

    /// The task of a job array. With `places`, its number is its place in the array of Slurm, and otherwise its id.
    fn array(&self, places: bool) -> Result<Option<Claim>, JobError> {
        if let Some(id) = self.number(SLURM_ARRAY[0])? {
            let found = self.found(&SLURM_ARRAY);
            if !places {
                return Ok(Some(Claim { number: id, base: 1, count: self.number(SLURM_ARRAY[3])?, found }));
            }
            let [first, last, count] = [SLURM_ARRAY[1], SLURM_ARRAY[2], SLURM_ARRAY[3]].map(|name| self.number(name));
            let (Some(first), Some(last), Some(count)) = (first?, last?, count?) else {
                return Err(JobError::NoCount { found });
            };
            // An array of one task has no step.
            let step = self.number(SLURM_ARRAY[4])?.unwrap_or(1).max(1);
            let place =
                |id: usize| id.checked_sub(first).filter(|offset| offset % step == 0).map(|offset| offset / step);
            return match (place(id), place(last)) {
                (Some(number), Some(end)) if number <= end && end.checked_add(1) == Some(count) => {
                    Ok(Some(Claim { number, base: 0, count: Some(count), found }))
                }
                _ => Err(JobError::Uneven { found }),
            };
        }
        for name in PBS_ARRAYS {
            if let Some(number) = self.number(name)? {
                return Ok(Some(Claim { number, base: 1, count: None, found: self.found(&[name]) }));
            }
        }
        Ok(None)
    }

    /// The rank from MPI launchers, which must all agree.
    ///
    /// Variables of srun do not count here, because srun may have started the launcher once on each node.
    fn rank(&self) -> Result<Option<Claim>, JobError> {
        let mut agreed: Option<Claim> = None;
        for (rank, size) in MPI {
            let Some(number) = self.number(rank)? else { continue };
            let count = self.number(size)?;
            let found = self.found(&[rank, size]);
            match &mut agreed {
                None => agreed = Some(Claim { number, base: 0, count, found }),
                Some(claim) => {
                    let differs = count.is_some() && claim.count.is_some() && claim.count != count;
                    if claim.number != number || differs {
                        return Err(JobError::Contradiction { one: claim.found.clone(), other: found });
                    }
                    claim.count = claim.count.or(count);
                }
            }
        }
        let Some(mut claim) = agreed else { return Ok(None) };
        if claim.count.is_none() && self.number(SLURM_STEP[1])? == Some(claim.number) {
            // PMIx under srun.
            claim.count = self.number(SLURM_STEP[2])?;
        }
        Ok(Some(claim))
    }

    /// The task that srun started.
    fn step(&self, in_array: bool) -> Result<Option<Claim>, JobError> {
        let [_, id, tasks] = SLURM_STEP;
        match (self.number(id)?, self.number(tasks)?) {
            (Some(number), Some(count)) => {
                Ok(Some(Claim { number, base: 0, count: Some(count), found: self.found(&[id, tasks]) }))
            }
            _ if in_array || self.number("SLURM_NTASKS")?.is_none_or(|tasks| tasks == 1) => Ok(None),
            _ => Err(JobError::NotStarted { found: self.found(&["SLURM_NTASKS"]) }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shard in an environment that is written as `A=1 B=2`.
    fn shard(count: Option<usize>, environment: &str) -> Result<String, String> {
        let value = |name: &str| {
            let pairs = environment.split_whitespace().filter_map(|pair| pair.split_once('='));
            pairs.into_iter().find(|(other, _)| *other == name).map(|(_, value)| value.to_owned())
        };
        Shard::of_job(count, &value).map(|shard| shard.to_string()).map_err(|error| error.to_string())
    }

    fn slurm(id: usize, first: usize, last: usize, count: usize, step: usize) -> String {
        format!(
            "SLURM_ARRAY_TASK_ID={id} SLURM_ARRAY_TASK_MIN={first} SLURM_ARRAY_TASK_MAX={last} \
             SLURM_ARRAY_TASK_COUNT={count} SLURM_ARRAY_TASK_STEP={step}"
        )
    }

    #[test]
    fn tasks_and_ranks_are_counted_from_one() {
        let batch = "SLURM_PROCID=0 SLURM_NTASKS=4";
        for (environment, expected) in [
            (slurm(1, 1, 8, 8, 1), "1/8"),
            (slurm(0, 0, 7, 8, 1), "1/8"),
            (slurm(7, 0, 7, 8, 1), "8/8"),
            (slurm(6, 2, 8, 4, 2), "3/4"),
            // The batch script of a task that may start four more, and the tasks of an array of one task.
            (format!("{} {batch}", slurm(2, 1, 3, 3, 1)), "2/3"),
            (format!("{} PMI_RANK=2 PMI_SIZE=5", slurm(4, 4, 4, 1, 1)), "3/5"),
            ("SLURM_STEP_ID=0 SLURM_PROCID=2 SLURM_NTASKS=4 SLURM_STEP_NUM_TASKS=4".to_owned(), "3/4"),
            ("OMPI_COMM_WORLD_RANK=3 OMPI_COMM_WORLD_SIZE=4 PMIX_RANK=3".to_owned(), "4/4"),
            // srun starts the daemons of Open MPI, once on each node.
            (format!("OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=16 {batch}"), "1/16"),
            ("PMI_RANK=0 PMI_SIZE=2".to_owned(), "1/2"),
            ("PMIX_RANK=1 SLURM_STEP_ID=0 SLURM_PROCID=1 SLURM_STEP_NUM_TASKS=2".to_owned(), "2/2"),
        ] {
            assert_eq!(shard(None, &environment).as_deref(), Ok(expected), "{environment}");
        }
    }

    #[test]
    fn a_number_of_shards_that_is_given_goes_with_the_ids_of_an_array() {
        for (environment, expected) in [
            ("PBS_ARRAY_INDEX=3".to_owned(), "3/8"),
            ("PBS_ARRAYID=8".to_owned(), "8/8"),
            // One task that was submitted again.
            (slurm(5, 5, 5, 1, 1), "5/8"),
            ("PMIX_RANK=0".to_owned(), "1/8"),
            ("PMI_RANK=7 PMI_SIZE=8".to_owned(), "8/8"),
        ] {
            assert_eq!(shard(Some(8), &environment).as_deref(), Ok(expected), "{environment}");
        }
    }

    #[test]
    fn what_is_missing_or_contradicts_is_named() {
        let uneven = "SLURM_ARRAY_TASK_ID=4, SLURM_ARRAY_TASK_MIN=1, SLURM_ARRAY_TASK_MAX=9, SLURM_ARRAY_TASK_COUNT=3";
        for (count, environment, expected) in [
            (None, String::new(), "none of SLURM_ARRAY_TASK_ID, "),
            (None, "PBS_ARRAY_INDEX=3".to_owned(), "PBS_ARRAY_INDEX=3 does not say how many tasks there are"),
            (None, "SLURM_ARRAY_TASK_ID=3".to_owned(), "SLURM_ARRAY_TASK_ID=3 does not say how many tasks there are"),
            (None, "PMIX_RANK=3".to_owned(), "PMIX_RANK=3 does not say how many tasks there are"),
            (None, slurm(4, 1, 9, 3, 1), uneven),
            (None, slurm(9, 1, 8, 8, 1), "the indices of the tasks are not evenly spaced"),
            (None, "SLURM_ARRAY_TASK_ID=x".to_owned(), "SLURM_ARRAY_TASK_ID is 'x', not a number"),
            (None, "SLURM_PROCID=0 SLURM_NTASKS=4".to_owned(), "SLURM_NTASKS=4, but srun did not start this process"),
            (Some(8), "PBS_ARRAY_INDEX=0".to_owned(), "PBS_ARRAY_INDEX=0 is outside 1 to 8"),
            (Some(8), "PBS_ARRAY_INDEX=9".to_owned(), "PBS_ARRAY_INDEX=9 is outside 1 to 8"),
            (Some(8), "PMI_RANK=0 PMI_SIZE=4".to_owned(), "auto/8 contradicts PMI_RANK=0, PMI_SIZE=4"),
            (None, "PMI_RANK=4 PMI_SIZE=4".to_owned(), "PMI_RANK=4, PMI_SIZE=4 is outside 1 to 4"),
            (
                None,
                "PMI_RANK=1 PMI_SIZE=4 OMPI_COMM_WORLD_RANK=2 OMPI_COMM_WORLD_SIZE=4".to_owned(),
                "OMPI_COMM_WORLD_RANK=2, OMPI_COMM_WORLD_SIZE=4 contradicts PMI_RANK=1, PMI_SIZE=4",
            ),
            (
                None,
                format!("{} PMI_RANK=1 PMI_SIZE=4", slurm(1, 1, 2, 2, 1)),
                "SLURM_ARRAY_TASK_STEP=1 contradicts PMI_RANK=1",
            ),
        ] {
            let error = shard(count, &environment).expect_err(&environment);
            assert!(error.contains(expected), "{environment}: {error}");
        }
    }
}
