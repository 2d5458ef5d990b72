//! `cargo xtask slurm`: a sweep as a job array on a Slurm cluster of one node.
//!
//! One of the tasks is killed and requeued.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use rc_figures::repository;

use crate::process::{cargo, path_of, run as run_step, wait};

/// Runs a job array on its own Slurm, and kills and requeues a task.
///
/// The merged result is compared with that of one process. Slurm needs no set-up: controller and node run in a folder
/// that is removed, with other ports than the system's. Without Slurm it says so and succeeds (Debian: slurm-wlm).
#[derive(clap::Args)]
pub(crate) struct Args {}

/// Programs of Slurm that are needed.
const PROGRAMS: [&str; 7] = ["slurmctld", "slurmd", "sinfo", "sbatch", "squeue", "scontrol", "scancel"];

/// The sweep: 4 parts of 15 rows, each of some hundredths of a second.
const SWEEP: [&str; 10] =
    ["sweep", "--waves", "16", "--grid", "256", "--pressures", "1e5:1e6:6", "--seeds", "1..10", "--threads=1"];
const TASKS: usize = 4;
const ROWS: usize = 60;

/// Number of the task that is killed.
const KILLED: usize = 2;

/// Columns that depend on the run, not on the result.
const OF_THE_RUN: [&str; 2] = ["wall_seconds", "peak_memory_bytes"];

#[expect(clippy::print_stderr, reason = "a task runner says what it runs")]
pub(crate) fn run(_args: &Args) -> Result<()> {
    if let Some(missing) = PROGRAMS.iter().find(|program| path_of(program).is_none()) {
        eprintln!("slurm: skipped, there is no {missing} here (Debian: apt-get install slurm-wlm)");
        return Ok(());
    }
    run_step(&mut cargo(&["build", "--release", "--package", "rc-cli"]))?;
    let folder = tempfile::tempdir()?;
    let rc = Rc { program: repository::target().join("release/rc"), folder: folder.path().to_owned() };
    rc.run(&[&SWEEP[..], &["--quiet", "--out", "whole"]].concat())?;
    let slurm = Slurm::start(folder.path())?;
    let job = slurm.submit(&rc)?;
    eprintln!("slurm: job {job} with {TASKS} tasks");
    let rows = kill_amid(&rc)?;
    eprintln!("slurm: task {KILLED} killed after {rows} rows");
    let task = format!("{job}_{KILLED}");
    // Slurm needs a moment to see that the task has ended.
    wait("task is requeued", || Ok(slurm.ask("scontrol", &["requeue", &task]).is_ok()))?;
    wait("job ends", || {
        // Slurm delays a requeued task by two minutes, from some moment after the request on. The update ends the
        // delay; it fails where the task has started since.
        if slurm.ask("squeue", &["--noheader", "--states=PENDING", "--format=%r"])?.contains("BeginTime") {
            slurm.ask("scontrol", &["update", &format!("JobId={task}"), "StartTime=now"]).ok();
        }
        Ok(slurm.ask("squeue", &["--noheader"])?.is_empty())
    })?;
    let parts: Vec<String> = (1..=TASKS).map(|index| format!("parts/part-{index}-of-{TASKS}")).collect();
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    rc.run(&[&["sweep", "merge"], &parts[..], &["--out", "merged"]].concat())?;
    let (whole, merged) = (rc.table("whole")?, rc.table("merged")?);
    ensure!(whole.len() == 1 + ROWS, "one process gave {} lines, not {}", whole.len(), 1 + ROWS);
    ensure!(whole == merged, "the merged table is not that of one process");
    eprintln!("slurm: {ROWS} rows of {TASKS} tasks are those of one process, digit by digit");
    Ok(())
}

/// Kills the process of the task while rows are left, and returns the finished ones.
fn kill_amid(rc: &Rc) -> Result<usize> {
    wait("task has finished two rows", || Ok(rc.finished_rows(KILLED) >= 2))?;
    let pid = std::fs::read_to_string(rc.folder.join(format!("pid-{KILLED}")))?;
    let killed = Command::new("kill").args(["-KILL", pid.trim()]).status()?;
    let rows = rc.finished_rows(KILLED);
    ensure!(killed.success() && rows < ROWS / TASKS, "task {KILLED} was faster than the kill");
    Ok(rows)
}

/// The program, and the folder in which it works.
struct Rc {
    program: PathBuf,
    folder: PathBuf,
}

impl Rc {
    fn run(&self, words: &[&str]) -> Result<()> {
        let output = Command::new(&self.program).args(words).current_dir(&self.folder).output()?;
        ensure!(output.status.success(), "rc {}: {}", words.join(" "), String::from_utf8_lossy(&output.stderr).trim());
        Ok(())
    }

    /// Number of rows in the journal of a part.
    fn finished_rows(&self, part: usize) -> usize {
        let journal = self.folder.join(format!("parts/part-{part}-of-{TASKS}/sweep.jsonl"));
        std::fs::read_to_string(journal).map_or(0, |text| text.matches('\n').count().saturating_sub(1))
    }

    /// The table of a sweep without the columns of the run.
    fn table(&self, folder: &str) -> Result<Vec<Vec<String>>> {
        let path = self.folder.join(folder).join("sweep.csv");
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_path(path)?;
        let records = reader.records().collect::<Result<Vec<_>, _>>()?;
        let names = records.first().context("an empty table")?.clone();
        let of_result = |row: &csv::StringRecord| {
            let cells = names.iter().zip(row).filter(|(name, _)| !OF_THE_RUN.contains(name));
            cells.map(|(_, cell)| cell.to_owned()).collect()
        };
        Ok(records.iter().map(of_result).collect())
    }
}

/// A controller and a node, which end when this is dropped.
struct Slurm {
    folder: PathBuf,
    daemons: Vec<Child>,
}

impl Slurm {
    /// Starts controller and node, and waits until the node takes jobs.
    fn start(folder: &Path) -> Result<Self> {
        let host = text_of(Command::new("hostname").arg("-s"))?;
        let user = text_of(Command::new("id").arg("-un"))?;
        let ports = [free_port()?, free_port()?];
        for name in ["state", "spool"] {
            std::fs::create_dir(folder.join(name))?;
        }
        std::fs::write(folder.join("slurm.conf"), configuration(folder, &host, &user, ports))?;
        let mut slurm = Self { folder: folder.to_owned(), daemons: Vec::new() };
        for name in ["slurmctld", "slurmd"] {
            let mut command = slurm.command(name, &["-D", "-f"])?;
            command.arg(folder.join("slurm.conf")).stdout(Stdio::null()).stderr(Stdio::null());
            slurm.daemons.push(command.spawn().with_context(|| format!("{name} does not start"))?);
        }
        let idle = || Ok(slurm.ask("sinfo", &["--noheader", "--format=%t"]).is_ok_and(|state| state == "idle"));
        if let Err(error) = wait("node is idle", idle) {
            let log = std::fs::read_to_string(folder.join("slurmd.log")).unwrap_or_default();
            bail!("{error}; slurmd: {}", log.lines().last().unwrap_or("no log"));
        }
        Ok(slurm)
    }

    /// Submits the job array, and returns its number.
    fn submit(&self, rc: &Rc) -> Result<String> {
        let words = SWEEP.join(" ");
        let script = format!(
            "#!/bin/sh\necho $$ > pid-$SLURM_ARRAY_TASK_ID\n\
             exec '{}' {words} --quiet --shard auto --resume --out parts\n",
            rc.program.display()
        );
        std::fs::write(self.folder.join("job.sh"), script)?;
        let array = format!("--array=1-{TASKS}");
        self.ask("sbatch", &["--parsable", "--output=log-%a", "--open-mode=append", &array, "job.sh"])
    }

    fn command(&self, program: &str, words: &[&str]) -> Result<Command> {
        let mut command = Command::new(path_of(program).with_context(|| format!("there is no {program}"))?);
        command.args(words).current_dir(&self.folder).env("SLURM_CONF", self.folder.join("slurm.conf"));
        Ok(command)
    }

    /// The output of a program of Slurm.
    fn ask(&self, program: &str, words: &[&str]) -> Result<String> {
        text_of(&mut self.command(program, words)?)
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        // A task that has ended already cannot be cancelled.
        let _ = self.ask("scancel", &["--quiet", "--state=RUNNING"]);
        for daemon in self.daemons.iter_mut().rev() {
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

/// The configuration of one node without authentication.
///
/// All ports are on this machine, and all files are in `folder`.
fn configuration(folder: &Path, host: &str, user: &str, [controller, node]: [u16; 2]) -> String {
    let folder = folder.display();
    format!(
        "ClusterName=rc\nSlurmctldHost={host}(127.0.0.1)\nSlurmctldPort={controller}\nSlurmdPort={node}\n\
         AuthType=auth/none\nCredType=cred/none\nSlurmUser={user}\nSlurmdUser={user}\n\
         StateSaveLocation={folder}/state\nSlurmdSpoolDir={folder}/spool\n\
         SlurmctldPidFile={folder}/slurmctld.pid\nSlurmdPidFile={folder}/slurmd.pid\n\
         SlurmctldLogFile={folder}/slurmctld.log\nSlurmdLogFile={folder}/slurmd.log\n\
         ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSwitchType=switch/none\nMpiDefault=none\n\
         SelectType=select/cons_tres\nSelectTypeParameters=CR_CPU\nReturnToService=2\nSchedulerType=sched/builtin\n\
         JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n\
         NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n\
         PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP\n"
    )
}

/// A port that is not in use now.
fn free_port() -> Result<u16> {
    Ok(std::net::TcpListener::bind(("127.0.0.1", 0))?.local_addr()?.port())
}

fn text_of(command: &mut Command) -> Result<String> {
    let output = command.output()?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr).trim());
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
