//! The last minutes of a live machine: copies of it, one for each second, and every command since the oldest of them. Any moment between is
//! computed again from the copy before it, with the same commands at the same steps, and is therefore the same to the last byte.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::machine::{Command, Machine};
use crate::scenario::Transcript;
use crate::source::Problem;
use crate::units::Time;

/// The number of copies that are kept.
const POINTS: usize = 300;
/// The time of the machine between two copies.
const APART: Time = Time::from_millis(1000);
/// The least time between two copies by the clock of the computer: a machine far above real time does not copy itself all the time.
const LEAST: Duration = Duration::from_millis(200);

/// The machine at a moment.
#[derive(Debug)]
struct Point {
    machine: Machine,
    transcript: Option<Transcript>,
}

/// The last minutes.
#[derive(Debug)]
pub(super) struct History {
    points: VecDeque<Point>,
    copied: Option<Instant>,
    /// The commands at the start of the step after a cycle, oldest first.
    commands: VecDeque<(u64, Vec<Command>)>,
    /// Everything since power on, as a scenario.
    transcript: Option<Transcript>,
    /// Why the machine cannot be copied.
    refusal: Option<Arc<str>>,
}

/// The moments to which a machine can go back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reach {
    /// The first cycle.
    pub first: u64,
    /// Its time.
    pub time: Time,
}

impl History {
    pub(super) fn new(transcript: Option<Transcript>) -> Self {
        Self { points: VecDeque::new(), copied: None, commands: VecDeque::new(), transcript, refusal: None }
    }

    /// Takes a note of the scenario, which belongs to the next step.
    pub(super) fn note(&mut self, text: &str) {
        if let Some(transcript) = &mut self.transcript {
            transcript.note(text);
        }
    }

    /// Copies the machine if it is time, and records the commands of the step that follows immediately.
    pub(super) fn edge(&mut self, machine: &Machine) {
        let is_due = self.points.back().is_none_or(|last| machine.time() - last.machine.time() >= APART)
            && self.copied.is_none_or(|copied| copied.elapsed() >= LEAST)
            && self.refusal.is_none();
        if is_due {
            self.copy(machine);
        }
        if let Some(transcript) = &mut self.transcript {
            transcript.edge(machine, &[]);
        }
        if !machine.queued().is_empty() && self.refusal.is_none() {
            self.commands.push_back((machine.cycle(), machine.queued().to_vec()));
        }
    }

    fn copy(&mut self, machine: &Machine) {
        // The commands that wait for the next step are a part of the copy; they are recorded with their step as well, so they go.
        match machine.fork() {
            Ok(machine) => self.points.push_back(Point { machine, transcript: self.transcript.clone() }),
            Err(problem) => self.refusal = Some(problem.what.into()),
        }
        self.copied = Some(Instant::now());
        if self.points.len() > POINTS {
            self.points.pop_front();
            let first = self.points.front().map_or(0, |point| point.machine.cycle());
            self.commands.retain(|(cycle, _)| *cycle >= first);
        }
    }

    /// The moments to which the machine can go back; the reason if there is none.
    pub(super) fn reach(&self) -> Result<Reach, Arc<str>> {
        if let Some(refusal) = &self.refusal {
            return Err(Arc::clone(refusal));
        }
        let first = self.points.front().ok_or("the machine has taken no step")?;
        Ok(Reach { first: first.machine.cycle(), time: first.machine.time() })
    }

    /// The machine as it was after a cycle. What happened later is forgotten.
    pub(super) fn back_to(&mut self, cycle: u64) -> Result<Machine, Problem> {
        let cure = "a machine that keeps a history goes back, if its PLC program is not in another process";
        let Reach { first, time } = self.reach().map_err(|refusal| Problem::new(&*refusal, cure))?;
        let later = self.points.iter().position(|point| point.machine.cycle() > cycle).unwrap_or(self.points.len());
        let Some(index) = later.checked_sub(1) else {
            let what = format!("expected a moment of the last minutes, found cycle {cycle}");
            return Err(Problem::new(what, format!("the oldest moment that is kept is cycle {first}, {time} s")));
        };
        let mut machine = self.points[index].machine.fork()?;
        let mut transcript = self.points[index].transcript.clone();
        let mut commands =
            self.commands.iter().filter(|(at, _)| *at >= machine.cycle()).cloned().collect::<VecDeque<_>>();
        machine.forget_queued();
        while machine.cycle() < cycle {
            if let Some((_, due)) = commands.pop_front_if(|(at, _)| *at == machine.cycle()) {
                for command in due {
                    // It was accepted in this state before.
                    let _ = machine.queue(command);
                }
            }
            if let Some(transcript) = &mut transcript {
                transcript.edge(&machine, &[]);
            }
            machine.step();
            machine.drain();
        }
        self.points.truncate(index + 1);
        self.commands.retain(|(at, _)| *at < cycle);
        (self.transcript, self.copied) = (transcript, None);
        Ok(machine)
    }

    /// Everything since power on as a scenario that repeats it, up to a cycle.
    pub(super) fn scenario(&self, cycle: u64) -> Option<String> {
        let mut transcript = self.transcript.clone()?;
        let text = transcript.take_text();
        Some(format!("{text}{}", transcript.rest(cycle)))
    }
}
