//! Other programs that solve the same problem.
//!
//! Each is a process that runs `crates/rc-bench/peers/peers.py`.

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use rc_figures::repository;
use rc_solver::Tolerance;

use super::machine::all_threads;
use super::measure::Outcome;
use super::setting::CERTIFIED;

/// A peer and its tolerances.
#[derive(Clone, Copy, Debug)]
pub(super) struct PeerKind {
    pub(super) name: &'static str,
    /// Name in tables and pictures.
    pub(super) title: &'static str,
    pub(super) tolerances: &'static [Tolerance],
    /// Whether it takes a tolerance. If not, it derives one from the heights.
    pub(super) takes_tolerance: bool,
    /// Whether its packages on PyPI use only one thread.
    pub(super) is_serial: bool,
}

/// The fastest peer. Its tolerance has the same meaning as ours, so it also gets `auto`.
pub(super) const ASPHER: PeerKind = PeerKind {
    name: "aspher",
    title: "ASPHER",
    tolerances: &[CERTIFIED, Tolerance::Auto],
    takes_tolerance: true,
    is_serial: false,
};

/// A peer whose tolerance is relative as well.
pub(super) const TAMAAS: PeerKind =
    PeerKind { name: "tamaas", title: "Tamaas", tolerances: &[CERTIFIED], takes_tolerance: true, is_serial: true };

const CONTACT_MECHANICS: PeerKind =
    PeerKind { name: "contactmechanics", title: "ContactMechanics", takes_tolerance: false, ..TAMAAS };

/// The peers.
pub(super) const PEERS: [PeerKind; 3] = [ASPHER, TAMAAS, CONTACT_MECHANICS];

/// A running peer.
pub(super) struct Peer {
    process: Child,
    questions: ChildStdin,
    answers: BufReader<ChildStdout>,
    /// Version, and options that change its speed.
    pub(super) version: String,
}

/// The first line that a peer writes.
#[derive(Deserialize)]
struct Greeting {
    version: String,
    fftw: bool,
}

/// One problem for a peer.
#[derive(Serialize)]
pub(super) struct Question<'a> {
    pub(super) heights: &'a Path,
    /// One of `stride` points along either side is taken.
    pub(super) stride: usize,
    pub(super) load: f64,
    pub(super) tolerance: Option<f64>,
}

impl Peer {
    /// Starts a peer with as many threads as we have.
    ///
    /// # Errors
    /// When the peer cannot be started or imported.
    pub(super) fn start(python: &Path, kind: &PeerKind) -> Result<Self> {
        let mut process = Command::new(python)
            .arg(repository::root().join("crates/rc-bench/peers/peers.py"))
            .arg(kind.name)
            .env("OMP_NUM_THREADS", all_threads().to_string())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .with_context(|| format!("could not start {}", python.display()))?;
        let questions = process.stdin.take().context("a piped process has an input")?;
        let answers = BufReader::new(process.stdout.take().context("a piped process has an output")?);
        let mut peer = Self { process, questions, answers, version: String::new() };
        let Greeting { version, fftw } = peer
            .answer()
            .with_context(|| format!("{} does not start in {}: is it installed there?", kind.name, python.display()))?;
        peer.version = if fftw { version + " (FFTW)" } else { version };
        Ok(peer)
    }

    /// Solves one problem.
    ///
    /// # Errors
    /// When the peer fails.
    pub(super) fn solve(&mut self, question: &Question<'_>) -> Result<Outcome> {
        let question = serde_json::to_string(question)?;
        writeln!(self.questions, "{question}").context("the peer is gone")?;
        self.answer()
    }

    fn answer<T: for<'a> Deserialize<'a>>(&mut self) -> Result<T> {
        let mut line = String::new();
        self.answers.read_line(&mut line).context("the peer is gone")?;
        serde_json::from_str(&line).with_context(|| format!("the peer answered '{}'", line.trim()))
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        // The process may have ended already. In either case it does not run on.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peer_that_is_not_installed_is_named() {
        let error = Peer::start(Path::new("no-such-python-anywhere"), &PEERS[1]).err().map(|error| error.to_string());
        assert!(error.as_ref().is_some_and(|text| text.contains("no-such-python-anywhere")), "{error:?}");
        // A program that writes nothing is not a peer.
        let error = Peer::start(Path::new("true"), &PEERS[1]).err().map(|error| error.to_string());
        assert!(error.is_none_or(|text| text.contains("tamaas") || text.contains("true")));
    }
}
