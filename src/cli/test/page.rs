//! `--html`: one page with each failure, its text and its timing diagram, and a table of all cases. It needs no other file.

use std::fmt::Write;
use std::time::Duration;

use super::work::{Ran, Work, sum};
use crate::golden::Outcome;
use crate::source::printable;

const HEAD: &str = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>OpenNCK scenarios</title>\n<style>\n\
    body { font: 15px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 80em; padding: 0 1em; color: #222; background: #fff }\n\
    h2 { margin-top: 2em; border-left: 6px solid #c00; padding-left: .5em; font-size: 1.1em }\n\
    pre { background: #f4f4f4; padding: 1em; overflow-x: auto }\n\
    figure { margin: 0; overflow-x: auto }\n\
    table { border-collapse: collapse } td, th { text-align: left; padding: .15em 1em .15em 0; border-bottom: 1px solid #ddd }\n\
    .passed { color: #060 } .bad { color: #c00; font-weight: bold }\n</style>\n</head>\n<body>\n";

/// The page of all cases that ran.
pub(super) fn text(done: &[(&Work, Ran)], left: usize, has_shard: bool, took: Duration) -> String {
    let mut text = HEAD.to_owned();
    let _ = writeln!(text, "<h1>{}</h1>\n<p>{:.1} s</p>", sum(done, left, has_shard), took.as_secs_f64());
    for (index, (work, ran)) in done.iter().enumerate() {
        if !ran.outcome.is_good() {
            failure(&mut text, index, work, ran);
        }
    }
    text += "<h1>All cases</h1>\n<table>\n<tr><th>case</th><th>result</th><th>time</th><th>rules</th></tr>\n";
    for (index, (work, ran)) in done.iter().enumerate() {
        row(&mut text, index, work, ran);
    }
    text + "</table>\n</body>\n</html>\n"
}

/// One failure: its name, the title of its scenario, what went wrong, and the signals.
fn failure(text: &mut String, index: usize, work: &Work, Ran { outcome, picture, .. }: &Ran) {
    let _ = writeln!(text, "<h2 id=\"case{index}\">{}</h2>", escaped(&work.name));
    if let Some(case) = work.case() {
        let _ = writeln!(text, "<p>{}</p>", escaped(&case.scenario.title));
    }
    let _ = writeln!(text, "<pre>{}</pre>", escaped(&outcome.to_string()));
    if let Some(picture) = picture {
        // Only the element: the declaration before it is that of a file of its own.
        let element = picture.find("<svg").map_or(picture.as_str(), |at| &picture[at..]);
        let _ = writeln!(text, "<figure>{element}</figure>");
    }
}

fn row(text: &mut String, index: usize, work: &Work, Ran { outcome, time, .. }: &Ran) {
    let result = match outcome {
        Outcome::Held => "passed",
        Outcome::Accepted => "accepted",
        Outcome::Failed(_) => "failed",
        Outcome::Untrue(_) => "wrong causes",
        Outcome::Differs(_) => "differs",
        Outcome::Missing(_) => "no golden file",
        Outcome::Unusable(_) => "unusable",
    };
    let result = match outcome.is_good() {
        true => format!("<span class=\"passed\">{result}</span>"),
        false => format!("<a class=\"bad\" href=\"#case{index}\">{result}</a>"),
    };
    let rules = work.case().map_or_else(String::new, |case| case.scenario.covers.join(" "));
    let (name, rules, seconds) = (escaped(&work.name), escaped(&rules), time.as_secs_f64());
    let _ = writeln!(text, "<tr><td>{name}</td><td>{result}</td><td>{seconds:.3} s</td><td>{rules}</td></tr>");
}

/// Characters that control a terminal are shown by their codes, as in the output on a terminal.
fn escaped(text: &str) -> String {
    printable(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
