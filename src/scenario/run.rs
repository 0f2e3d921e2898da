//! The scenario runner: prepares a scenario for a machine, so that every mistake is reported before anything runs, and runs it.

use std::path::{Path, PathBuf};

use super::conditions::condition;
use super::failure::{Failure, Progress};
use super::fields::{Named, in_the_case};
use super::file::Scenario;
use super::include::included_by;
use super::operator::{Operator, Plan, Stage};
use super::session::Session;
use super::steps::{Reader, Steps};
use super::timed::Timed;
use super::watching::RuleResult;
use crate::control::Read;
use crate::controls;
use crate::expression::Expression;
use crate::image::{Preset, Profile};
use crate::machine::{Command, Machine, OpenOptions};
use crate::monitor::{Claim, Rule};
use crate::plc::{Programs, step7};
use crate::source::{Place, Problem};
use crate::trace::{Curves, Head, Panel, Watch, Window};
use crate::units::{ChannelNumber, Time};

/// A scenario that is ready to run: the machine is open, names are looked up, values are checked.
pub struct Prepared {
    pub(super) session: Session,
    pub(super) plan: Plan,
    pub(super) head: Head,
    pub(super) causes: bool,
    /// Where the scenario names its PLC program, if this is in another process.
    pub(super) process: Option<Place>,
    pub(super) progress: Progress,
}

/// A scenario after its run.
pub struct Finished {
    pub(super) session: Session,
    pub(super) plan: Plan,
    pub(super) head: Head,
    pub(super) causes: bool,
    /// The part of the trace that waveform and diagram show.
    pub window: Window,
    /// Why it ended early, if it did.
    pub failure: Option<Failure>,
}

impl Scenario {
    /// Opens the machine under a profile, and looks up and checks everything that the steps name.
    ///
    /// # Errors
    /// Something is invalid; the problem names file and line.
    pub fn prepare(&self, profile: Profile, programs: &Programs) -> Result<Prepared, Problem> {
        self.prepare_on(profile, programs, controls::read)
    }

    /// The same with a control that this project does not know: `read` reads the files of the machine.
    ///
    /// # Errors
    /// As [`Scenario::prepare`].
    pub fn prepare_on(&self, profile: Profile, programs: &Programs, read: Read) -> Result<Prepared, Problem> {
        self.ready(profile, programs, read).map_err(|problem| in_the_case(problem, self.case().as_deref()))
    }

    /// The values of the matrix in this case.
    fn case(&self) -> Option<String> {
        self.variant.as_ref().map(ToString::to_string)
    }

    fn ready(&self, profile: Profile, programs: &Programs, read: Read) -> Result<Prepared, Problem> {
        let mut machine = self.open(profile, read)?;
        let watch = self.watch(&machine)?;
        let mut reader = Reader::new(&machine, &self.path);
        for folder in &self.program_path {
            reader.programs.search(&folder.text, self.directory(), &folder.place)?;
        }
        let selected = match &self.program {
            Some((text, true)) => Some(reader.programs.text(&text.text)),
            Some((file, false)) => Some(reader.programs.file(&file.text, self.directory(), &file.place)?),
            None => None,
        };
        let mut steps = Steps::default();
        reader.steps(&self.steps, &mut steps)?;
        let plan = Plan::new(steps, Timed::read(&self.at, &mut reader)?);
        let rules = self.rules(&mut reader, machine.cycle_time())?;
        let followed = std::mem::take(&mut reader.followed);
        let nc_programs = std::mem::take(&mut reader.programs);
        let looks_back = rules.iter().flat_map(Rule::expressions).any(Expression::looks_back) || plan.looks_back();
        let head = Head {
            title: self.title.clone(),
            machine: self.machine.text.clone(),
            profile: (profile != Profile::default()).then(|| profile.name().to_owned()),
            case: self.case(),
            cycle_time: machine.cycle_time(),
        };
        nc_programs.load(&mut machine);
        if let Some(path) = selected {
            machine.queue(Command::SelectProgram { channel: ChannelNumber::FIRST, path })?;
        }
        // A registered program is looked up last, so that mistakes in the file are reported first. One in a folder is there already.
        match &self.plc {
            Some(name) if !Programs::is_folder(&name.text) => {
                let program = programs.program(&name.text, machine.names());
                machine.load_program(program.map_err(|problem| problem.at(&name.place))?);
            }
            None if self.plc_process.is_none() => match machine.own_program() {
                Some((name, _)) if !Programs::is_folder(name) => machine.load_own_program(programs)?,
                _ => {}
            },
            _ => {}
        }
        if let Some((process, place)) = &self.plc_process {
            let program = programs.process(process, machine.memory(), machine.names(), machine.cycle_time());
            machine.load_program(program.map_err(|problem| problem.at(place))?);
        }
        let process = self.plc_process.as_ref().map(|(_, place)| place.clone());
        let mut session = Session::new(machine);
        session.set_watch(watch);
        let Session { machine, book, .. } = &mut session;
        book.look_back(looks_back, machine);
        book.limit = Some(self.limit);
        book.watch_over(rules, followed, machine);
        Ok(Prepared { session, plan, head, causes: self.causes, process, progress: Progress::New })
    }

    /// The machine as the scenario changes it, before its steps.
    ///
    /// # Errors
    /// A file of the machine, or what the scenario changes, is invalid; the problem names file and line.
    pub fn machine(&self, profile: Profile) -> Result<Machine, Problem> {
        self.open(profile, controls::read).map_err(|problem| in_the_case(problem, self.case().as_deref()))
    }

    /// Checks the signals to watch, the steps and the rules against the machine, without a PLC program.
    ///
    /// # Errors
    /// The first one that is invalid; the problem names file and line.
    pub fn check_steps(&self, profile: Profile) -> Result<(), Problem> {
        let checked = self.open(profile, controls::read).and_then(|machine| {
            self.watch(&machine)?;
            let mut reader = Reader::new(&machine, &self.path);
            reader.steps(&self.steps, &mut Steps::default())?;
            Timed::read(&self.at, &mut reader)?;
            self.rules(&mut reader, machine.cycle_time()).map(drop)
        });
        checked.map_err(|problem| in_the_case(problem, self.case().as_deref()))
    }

    fn open(&self, profile: Profile, read: Read) -> Result<Machine, Problem> {
        let image = |image: &Named| {
            let file = self.file_of(image)?;
            Preset::read(&file).map_err(|problem| problem.at(&image.place))
        };
        let preset = self.plc_image.as_ref().map(image).transpose()?;
        let scenario = Some(self.path.clone());
        let options = OpenOptions { plant_over: self.plant.clone(), profile, preset, scenario };
        let opened = read(&self.directory().join(&self.machine.text));
        let mut machine = opened
            .and_then(|(mut configuration, plant)| {
                configuration.store(&self.machine_data)?;
                Machine::of(&*configuration, plant, options)
            })
            .map_err(|problem| problem.at(&self.machine.place))?;
        self.load_folder(&mut machine)?;
        Ok(machine)
    }

    /// Loads a program in a folder, of the scenario or of its machine. Its data blocks and areas can be named by the steps.
    fn load_folder(&self, machine: &mut Machine) -> Result<(), Problem> {
        let programs = Programs::ready();
        if let Some(name) = &self.plc {
            if Programs::is_folder(&name.text) {
                let beside = self.directory().join(&self.machine.text);
                let loaded = machine.load_named(&name.text, &[self.directory(), &beside], &programs);
                loaded.map_err(|problem| problem.at(&name.place))?;
            }
        } else if self.plc_process.is_none() && machine.own_program().is_some_and(|(name, _)| Programs::is_folder(name))
        {
            machine.load_own_program(&programs)?;
        }
        Ok(())
    }

    /// The folder of its STEP 7 program, if it has one.
    #[must_use]
    pub fn plc_folder(&self) -> Option<PathBuf> {
        let name = self.plc.as_ref().filter(|name| Programs::is_folder(&name.text))?;
        Some(step7::folder(&name.text, &[self.directory(), &self.directory().join(&self.machine.text)]))
    }

    /// The file of the PLC image of the scenario, if it has one.
    ///
    /// # Errors
    /// No file has this name.
    pub fn image_file(&self) -> Result<Option<PathBuf>, Problem> {
        self.plc_image.as_ref().map(|image| self.file_of(image)).transpose()
    }

    /// The files and folders that it reads: the file itself, those that it includes, its machine, its PLC image, and files that the command of
    /// its PLC process names.
    #[must_use]
    pub fn inputs(&self) -> Vec<PathBuf> {
        let mut inputs = vec![self.path.clone()];
        let mut next = 0;
        while let Some(file) = inputs.get(next) {
            let included = included_by(file).unwrap_or_default();
            let new: Vec<PathBuf> = included.into_iter().filter(|file| !inputs.contains(file)).collect();
            inputs.extend(new);
            next += 1;
        }
        inputs.push(self.directory().join(&self.machine.text));
        inputs.extend(self.image_file().ok().flatten());
        inputs.extend(self.plc_folder());
        inputs.extend(self.plc_process.iter().flat_map(|(process, _)| process.files()));
        inputs
    }

    /// The file of a PLC image: a path, or a name that is searched in `plc_images` beside the scenario and in the folders above.
    fn file_of(&self, image: &Named) -> Result<PathBuf, Problem> {
        Ok(if image.text.ends_with(".toml") {
            self.directory().join(&image.text)
        } else {
            let name = Path::new("plc_images").join(format!("{}.toml", image.text));
            let above = self.directory().ancestors().map(|directory| directory.join(&name));
            // A relative path ends at the working directory; the folders above it are searched, too.
            let start = Path::new(".").join(self.directory()).canonicalize().unwrap_or_default();
            let further: Vec<PathBuf> = start.ancestors().map(|directory| directory.join(&name)).collect();
            above.chain(further).find(|file| file.is_file()).ok_or_else(|| {
                image.place.problem(
                    format!(
                        "PLC image plc_images/{}.toml does not exist beside the scenario or in a folder above it",
                        image.text
                    ),
                    "write a path that ends in .toml, relative to the scenario",
                )
            })?
        })
    }

    fn watch(&self, machine: &Machine) -> Result<Watch, Problem> {
        let Some(entries) = &self.watch else {
            return Ok(Watch::default());
        };
        let texts: Vec<_> = entries.iter().map(|entry| (entry.name.text.as_str(), entry.step)).collect();
        Watch::parse_stepped(&texts, machine.names(), machine.memory(), machine.variables())
            .map_err(|(index, problem)| problem.at(&entries[index].name.place))
    }

    /// The conditions and rules of the head.
    fn rules(&self, reader: &mut Reader<'_>, cycle: Time) -> Result<Vec<Rule>, Problem> {
        let mut rules = Vec::new();
        for (texts, claim) in
            [(&self.never, Claim::Never as fn(Expression) -> Claim), (&self.always, Claim::Always as _)]
        {
            for text in texts {
                let claim = claim(condition(text, reader)?);
                rules.push(Rule { name: None, place: Some(text.place.clone()), claim, go_on: false });
            }
        }
        for rule in &self.rules {
            rules.push(rule.prepared(reader, cycle)?);
        }
        Ok(rules)
    }
}

impl Prepared {
    /// Returns the machine, for a caller that steps it, the operator that executes the scenario, and the signals of the trace.
    #[must_use]
    pub fn into_operator(self) -> (Machine, Operator, Watch) {
        let Session { machine, book, watch, .. } = self.session;
        (machine, Operator::new(book, self.plan), watch)
    }

    /// Measures how near conditions come to their limits, too, for [`Finished::margins`]. This is slower and gives the same trace.
    #[must_use]
    pub fn measure_margins(mut self) -> Self {
        self.session.book.monitor.measure();
        self
    }

    /// Measures what causes name, too, for [`Trace::check_causes`](crate::trace::Trace::check_causes). This is slower and gives the same
    /// trace.
    #[must_use]
    pub fn measure_causes(mut self) -> Self {
        self.session.measure_causes();
        self
    }

    /// Moves, monitors and publishes every axis in every cycle, also an axis at rest. This is slower and gives the same trace.
    #[must_use]
    pub fn never_rest(mut self) -> Self {
        self.session.machine.never_rest();
        self
    }

    /// Decides everything for every axis in every cycle as well. This is slower still and gives the same trace.
    #[must_use]
    pub fn decide_always(mut self) -> Self {
        self.session.machine.decide_always();
        self
    }

    /// The machine before the first cycle.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.session.machine
    }

    /// The warnings from the files of the machine.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        self.session.machine().warnings()
    }
}

impl Finished {
    /// The body of the golden file: head and rows. Causes are included only if the scenario selects them.
    #[must_use]
    pub fn golden(&self) -> String {
        self.with_head(self.causes)
    }

    /// Head and rows with causes, for readers.
    #[must_use]
    pub fn text(&self) -> String {
        self.with_head(true)
    }

    fn with_head(&self, causes: bool) -> String {
        let rows = self.session.rows(causes);
        format!("{}\n{rows}", self.head)
    }

    /// The trace as JSON lines.
    #[must_use]
    pub fn json_lines(&self) -> String {
        self.session.json_lines()
    }

    /// The trace as a waveform (VCD), for GTKWave and similar viewers.
    #[must_use]
    pub fn vcd(&self) -> String {
        self.session.vcd_in(self.window)
    }

    /// The trace as a timing diagram.
    #[must_use]
    pub fn svg(&self) -> String {
        self.session.svg_in(self.window, &self.head)
    }

    /// Curves that were recorded during the run, as a diagram.
    #[must_use]
    pub fn plot(&self, curves: &Curves, panels: &[Panel]) -> String {
        let Session { machine, trace, .. } = &self.session;
        trace.plot(machine, curves, panels, self.window, &self.head)
    }

    /// What its rules have to say although they are not broken: rules that never began, and watches that are open.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = self.session.book.remarks();
        remarks.extend(self.plan.remarks());
        remarks.extend(self.stop_of_plc());
        remarks
    }

    /// The fault for which the PLC is in STOP at the end, in one line, unless the failure already says so.
    fn stop_of_plc(&self) -> Option<String> {
        let fault = self.session.machine().plc_fault()?.lines().next()?;
        let is_told = self.failure.as_ref().is_some_and(|failure| failure.to_string().contains(fault));
        (!is_told).then(|| format!("the PLC is in STOP: {fault}"))
    }

    /// The smallest margin of each rule, one line each.
    #[must_use]
    pub fn margins(&self) -> Vec<String> {
        self.session.book.margins()
    }

    /// What became of each rule, in the order of the file: `never`, `always`, `[[rule]]`.
    #[must_use]
    pub fn rules(&self) -> Vec<RuleResult> {
        self.session.book.rules()
    }

    /// Its steps, with those that it includes.
    #[must_use]
    pub fn stages(&self) -> Vec<Stage> {
        self.plan.stages()
    }

    /// The index of the step at which it ended: the one that failed, or the number of steps if all are done.
    #[must_use]
    pub fn reached(&self) -> usize {
        self.plan.index()
    }

    /// The machine at the end, with its trace.
    #[must_use]
    pub fn session(&self) -> &Session {
        &self.session
    }
}
