//! The arguments of `opennck test`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum};

/// What to run, how, and what to report.
#[derive(Clone, Debug, Args)]
pub(crate) struct Arguments {
    /// Directories or scenario files.
    #[arg(default_value = "golden", value_name = "PATH")]
    pub(super) paths: Vec<PathBuf>,
    /// Rewrites the golden files of traces that changed.
    #[arg(long)]
    pub(super) accept: bool,
    /// Also checks the cause of every edge of the control and of every alarm: its event happened in this cycle, has an input or a
    /// parent, and the inputs had the values that it names, lengths and velocities included.
    #[arg(long)]
    pub(super) check_causes: bool,
    /// Runs only the cases whose name contains this text, or that cite this rule in `covers`; may be given several times.
    ///
    /// The name of a case is its file, the values of its matrix and its profile, as `--list` prints it. Finding no case is an error.
    #[arg(long, value_name = "TEXT")]
    pub(super) filter: Vec<String>,
    /// Prints the names of the selected cases and runs nothing.
    #[arg(long, conflicts_with_all = ["accept", "junit", "html", "flowchart", "plc_coverage", "watch"])]
    pub(super) list: bool,
    /// Begins no further case after the first one that does not pass.
    #[arg(long)]
    pub(super) fail_fast: bool,
    /// Runs the third of sixteen parts of the selected cases: 3/16. All parts together run each case once.
    #[arg(long, value_name = "N/M")]
    pub(super) shard: Option<Shard>,
    /// Runs the cases in an order that follows from this number. It shows whether cases depend on each other.
    #[arg(long, value_name = "SEED")]
    pub(super) shuffle: Option<u64>,
    /// Runs the cases again when their files change, until Ctrl-C.
    #[arg(long)]
    pub(super) watch: bool,
    /// Writes a report in JUnit format.
    #[arg(long, value_name = "F.xml")]
    pub(super) junit: Option<PathBuf>,
    /// Writes a page with each failure, its text and its timing diagram.
    #[arg(long, value_name = "F.html")]
    pub(super) html: Option<PathBuf>,
    /// Writes which statements, networks, branches and contacts of STEP 7 programs ran in all cases together.
    #[arg(long, value_name = "F.html|F.json|F.lcov")]
    pub(super) plc_coverage: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(super) format: Format,
    /// Number of scenarios that run at the same time [default: the number of processors].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) jobs: Option<u16>,
    /// Writes the flowchart of referencing and gantry as Mermaid; transitions that the scenarios took are marked.
    #[arg(long, value_name = "F.mmd")]
    pub(super) flowchart: Option<PathBuf>,
}

/// Output format of `opennck test`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// For people.
    Text,
    /// The same, and an annotation of GitHub Actions for each failure.
    Github,
}

/// One of several parts of equal size, counted from one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    pub(crate) part: usize,
    pub(crate) of: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts =
            text.split_once('/').and_then(|(part, of)| Some(Self { part: part.parse().ok()?, of: of.parse().ok()? }));
        parts
            .filter(|shard| (1..=shard.of).contains(&shard.part))
            .ok_or_else(|| format!("expected a part and the number of parts such as 3/16, found {text}"))
    }
}
