//! CHANGING ENTRIES: before the first start (`[machine_data]` of a scenario) and at run time (the verb `list`).
//!
//! A target is an owner and a parameter: `ax6:kenngr.gantry_ax_nr`, `channel_1:P-CHAN-00104`, or an axis by its name. A changed entry
//! is in effect with the next [`Lists::update`], unless its parameter waits for the start of the controller (HG-02).
//!
//! Decision. The logical number of a list (P-AXIS-00016) cannot be changed here, because it is how the axis is named everywhere else.

use crate::control::Value;
use crate::source::{Place, Problem, did_you_mean, nearest};

use super::list::{AXIS_NUMBER, Entry, List, Lists};
use super::name::{Meaning, meaning};
use super::parameter::{Effect, Index, Key, Parameter, Scope};
use super::table::PARAMETERS;
use super::value::convert;

/// A change of one entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change<'a> {
    /// Owner and parameter: `ax6:kenngr.gantry_ax_nr`.
    pub target: &'a str,
    /// The new value.
    pub value: &'a Value,
    /// Where the change is written.
    pub place: &'a Place,
}

impl Lists {
    /// Changes one entry, or adds it. Returns when it takes effect.
    ///
    /// # Errors
    /// There is no such axis, channel or parameter, the value does not fit, or the lists contradict each other then; nothing is changed.
    pub fn set(&mut self, target: &str, value: &Value, place: &Place) -> Result<Effect, Problem> {
        let effect = self.check(target, value).map_err(|problem| problem.at(place))?;
        self.set_all(&[Change { target, value, place }])?;
        Ok(effect)
    }

    /// Changes entries together: all of them, or none.
    ///
    /// # Errors
    /// As for [`Lists::set`]. The problem names the place of the change, or that of the entry that contradicts it.
    pub fn set_all(&mut self, changes: &[Change<'_>]) -> Result<(), Problem> {
        let mut changed = self.clone();
        for change in changes {
            changed.write(change).map_err(|problem| problem.at(change.place))?;
        }
        // The lists must also be possible after the next start.
        let mut started = changed.clone();
        started.adopt_all();
        if let Some(problem) = started.contradictions().into_iter().next() {
            return Err(problem);
        }
        *self = changed;
        Ok(())
    }

    /// The value that stands in a list, whether or not it is in effect; `None` without an entry.
    #[must_use]
    pub fn written(&self, target: &str) -> Option<&Value> {
        let (list, parameter, index) = self.target(target).ok()?;
        list.stored.get(&Key { number: parameter.number(), index }).map(|entry| &entry.value)
    }

    /// Checks a change of one entry without the other entries. Returns when it takes effect.
    ///
    /// # Errors
    /// There is no such axis, channel or parameter, or the value does not fit.
    pub fn check(&self, target: &str, value: &Value) -> Result<Effect, Problem> {
        let (_, parameter, index) = self.target(target)?;
        convert(parameter, index, value).map(|_| parameter.effect)
    }

    fn write(&mut self, change: &Change<'_>) -> Result<(), Problem> {
        let (list, parameter, index) = self.target(change.target)?;
        let (scope, number) = (list.scope, list.number);
        let value = convert(parameter, index, change.value)?;
        let (key, entry) = (Key { number: parameter.number(), index }, Entry { value, place: change.place.clone() });
        let lists = match scope {
            Scope::Axis => &mut self.axes,
            Scope::Channel => &mut self.channels,
        };
        if let Some(list) = lists.iter_mut().find(|list| list.number == number) {
            if parameter.effect == Effect::Update {
                list.active.insert(key, entry.clone());
            }
            list.stored.insert(key, entry);
        }
        Ok(())
    }

    /// The list and the parameter of a target.
    fn target(&self, target: &str) -> Result<(&List, &'static Parameter, Index), Problem> {
        let Some((owner, name)) = target.split_once(':') else {
            let what = format!("expected an axis or channel and a parameter, found `{target}`");
            return Err(Problem::new(what, "write \"ax6:kenngr.gantry_ax_nr\" or \"channel_1:P-CHAN-00104\""));
        };
        let (owner, name) = (owner.trim(), name.trim());
        let list = self.owner(owner)?;
        let cure = "write the index as a whole number from 0 in brackets: ax6:getriebe[0].dynamik.a_max";
        match meaning(name)
            .map_err(|what| Problem::new(format!("expected a parameter, found a broken index: {what}"), cure))?
        {
            Meaning::Known(parameter, _) if parameter.number() == AXIS_NUMBER => {
                let what = "expected a parameter that can change, found P-AXIS-00016 kopf.achs_nr, the number by which the axis is named";
                Err(Problem::new(what, "change it in the file"))
            }
            Meaning::Known(parameter, index) if parameter.scope == list.scope => Ok((list, parameter, index)),
            Meaning::Known(parameter, index) => {
                let (expected, instead) = match list.scope {
                    Scope::Axis => ("an axis", "channel_1:"),
                    Scope::Channel => ("a channel", "ax1:"),
                };
                let what = format!("expected a parameter of {expected}, found {}", parameter.title(index));
                Err(Problem::new(what, format!("write it with the right owner: \"{instead}{name}\"")))
            }
            Meaning::Unknown => {
                let names = PARAMETERS.iter().filter(|parameter| parameter.scope == list.scope);
                let names: Vec<String> =
                    names.map(|known| known.list_name([0, 0]).unwrap_or_else(|| known.id())).collect();
                let cure = did_you_mean(
                    name,
                    names.iter().map(String::as_str),
                    "use a list name or an ID, for example P-AXIS-00070",
                );
                Err(Problem::new(
                    format!("expected a parameter of {}, found `{name}`, which is not known", list.owner()),
                    cure,
                ))
            }
        }
    }

    fn owner(&self, name: &str) -> Result<&List, Problem> {
        let channel = self.channels.iter().find(|list| name == format!("channel_{}", list.number));
        if let Some(list) = channel {
            return Ok(list);
        }
        let axis = self.axis_numbers().find(|number| name == format!("ax{number}"));
        let axis = axis.or_else(|| self.update().axis_named(name)).and_then(|number| self.axis(number));
        axis.ok_or_else(|| {
            let axes = self.axis_numbers().map(|number| format!("ax{number}"));
            let known: Vec<String> =
                axes.chain(self.channels.iter().map(|list| format!("channel_{}", list.number))).collect();
            let cure = nearest(name, known.iter().map(String::as_str))
                .map_or_else(|| format!("use one of {}", known.join(", ")), |near| format!("did you mean `{near}`?"));
            Problem::new(format!("expected an axis or channel with a list, found `{name}`"), cure)
        })
    }
}
