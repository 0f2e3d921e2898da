//! The line at the bottom of the terminal while a machine is served: time, speed, clients, alarms.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::live::{Live, Speed};
use crate::s7::live::LiveServer;
use crate::scenario::State;
use crate::variables::Describe;

/// Period over which the rates are measured.
const RATES: Duration = Duration::from_secs(1);

/// Draws the status line, or nothing if standard error is not a terminal.
pub(super) fn status_line() -> ProgressBar {
    let bar = if std::io::stderr().is_terminal() {
        ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr())
    } else {
        ProgressBar::hidden()
    };
    bar.set_style(ProgressStyle::with_template("{wide_msg}").unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// The status line.
pub(super) struct Status<'a> {
    live: &'a Live,
    server: &'a LiveServer,
    /// The last measurement of the rates: real time, machine time, number of answers.
    last: (Instant, f64, u64),
    speed: Option<f64>,
    rate: u64,
}

impl<'a> Status<'a> {
    pub(super) fn new(live: &'a Live, server: &'a LiveServer) -> Self {
        let time = live.with(|machine| machine.time().seconds());
        Self { live, server, last: (Instant::now(), time, server.answers()), speed: None, rate: 0 }
    }

    pub(super) fn line(&mut self, wanted: Speed) -> String {
        if self.live.is_held() {
            return format!("step 0  waiting for a PLC process to open the image  clients {}", self.server.clients());
        }
        let looked = self.live.with_soon(|machine, scenario| {
            let name = |number| machine.alarm_name(number);
            let alarms: Vec<_> = machine.variables().alarms.iter().map(|alarm| name(alarm.number)).collect();
            (machine.time().seconds(), machine.cycle(), alarms, scenario.cloned())
        });
        let Some((time, cycle, alarms, scenario)) = looked else {
            // A scan in lock-step waits for its answer. Waiting for it here would delay Ctrl-C.
            return "waiting for the PLC process".to_owned();
        };
        let elapsed = self.last.0.elapsed();
        if elapsed >= RATES {
            let answers = self.server.answers();
            self.speed = Some((time - self.last.1) / elapsed.as_secs_f64());
            let millis = u64::try_from(elapsed.as_millis()).unwrap_or(u64::MAX).max(1);
            self.rate = (answers - self.last.2) * 1000 / millis;
            self.last = (Instant::now(), time, answers);
        }
        let speed = self.speed.map_or_else(|| wanted.to_string(), |speed| format!("{speed:.2}"));
        let alarms = if alarms.is_empty() { "none".to_owned() } else { alarms.join(" ") };
        let mut line = format!("{time:.1} s  step {cycle}  speed {speed}");
        if self.live.pace().overruns > 0 {
            line += &format!("  {}", self.overruns());
        }
        if let Some(scenario) = scenario {
            let how = match scenario {
                State::Acting => "running",
                State::Done => "passed",
                State::Failed(_) => "FAILED",
            };
            line += &format!("  scenario {how}");
        }
        line += &format!("  clients {} ({}/s)  alarms {alarms}", self.server.clients(), self.rate);
        line
    }

    fn overruns(&self) -> String {
        let pace = self.live.pace();
        let mut text = format!("overruns {} (worst {} ms", pace.overruns, pace.worst.as_millis());
        if !pace.lost.is_zero() {
            text += &format!(", lost {:.1} s", pace.lost.as_secs_f64());
        }
        text + ")"
    }

    /// The summary of the whole run.
    pub(super) fn sum(&self) -> String {
        let step = self.live.with(|machine| machine.cycle());
        format!("step {step}  {}  answers {}", self.overruns(), self.server.answers())
    }
}
