//! `report.html`: one page that needs no other file. Its first screen says what to do.

use std::fmt::Write;
use std::path::Path;

use super::answer::{Answer, counts, in_words, next, values};
use crate::campaign::{Spec, Summary};
use crate::source::printable;

const HEAD: &str = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
    <meta name=\"viewport\" content=\"width=device-width\">\n<title>OpenNCK campaign</title>\n<style>\n\
    body { font: 15px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 70em; padding: 0 1em; color: #222; background: #fff }\n\
    h2 { margin-top: 1.5em; border-left: 6px solid #c00; padding-left: .5em; font-size: 1.1em } h2.plain { border-color: #888 }\n\
    pre, code { background: #f4f4f4 } pre { padding: .7em; overflow-x: auto } .good { color: #060 } .bad { color: #c00 }\n\
    table { border-collapse: collapse } td, th { text-align: left; padding: .15em 1em .15em 0; border-bottom: 1px solid #ddd; vertical-align: top }\n\
    ul { columns: 20em }\n</style>\n</head>\n<body>\n";

pub(super) fn text(spec: &Spec, summary: &Summary, answers: &[Answer], missing: &[String]) -> String {
    let mut text = HEAD.to_owned();
    let class = if summary.is_good() { "good" } else { "bad" };
    let _ = writeln!(
        text,
        "<h1>{}</h1>\n<p class=\"{class}\"><b>{}</b>; {}</p>",
        escaped(&spec.title),
        escaped(&counts(summary)),
        escaped(&spec.strategy())
    );
    if summary.is_good() {
        text += "<p>Nothing to do: every case held, and everything was reached that must be.</p>\n";
    }
    for (index, answer) in answers.iter().enumerate() {
        group(&mut text, index, answer);
    }
    for one in &summary.never_reached {
        let _ = writeln!(
            text,
            "<h2>No case reached <code>{}</code></h2>\n<p>Next: vary more, or longer; or this cannot happen.</p>",
            escaped(one)
        );
    }
    for boundary in &summary.boundaries {
        let _ = writeln!(text, "<h2 class=\"plain\">Boundary</h2>\n<p>{}</p>", escaped(&in_words(boundary)));
    }
    if !summary.margins.is_empty() {
        text += "<h2 class=\"plain\">Smallest margins</h2>\n<table>\n<tr><th>margin</th><th>rule</th><th>case</th><th>values</th></tr>\n";
        for row in &summary.margins {
            let unit = if row.in_cycles { " cycles" } else { "" };
            let class = if row.amount < 0.0 { " class=\"bad\"" } else { "" };
            let values: Vec<_> = row.values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
            let (rule, values) = (escaped(&row.rule), escaped(&values.join(", ")));
            let _ = writeln!(
                text,
                "<tr><td{class}>{}{unit}</td><td>{rule}</td><td>{}</td><td>{values}</td></tr>",
                row.amount, row.case
            );
        }
        text += "</table>\n";
    }
    text += "<h2 class=\"plain\">What varied</h2>\n<table>\n";
    for (name, count) in spec.varied() {
        let _ = writeln!(text, "<tr><td>{}</td><td>{count}</td></tr>", escaped(&name));
    }
    text += "</table>\n";
    let _ = writeln!(
        text,
        "<h2 class=\"plain\">What no case reached: {} of {}</h2>\n<ul>",
        missing.len(),
        missing.len() + summary.reached.len()
    );
    for one in missing {
        let _ = writeln!(text, "<li>{}</li>", escaped(one));
    }
    text + "</ul>\n</body>\n</html>\n"
}

fn group(text: &mut String, index: usize, answer: &Answer) {
    let group = &answer.group;
    let noun = if group.count == 1 { "case" } else { "cases" };
    let _ = writeln!(text, "<h2>{}. {} {noun}: {}</h2>", index + 1, group.count, escaped(&group.failure));
    let _ = writeln!(text, "<p>Next: <code>{}</code></p>", escaped(&next(answer, Path::new(""))));
    if !group.chain.is_empty() {
        let _ = writeln!(text, "<p>Because of {}</p>", escaped(&group.chain.join(" <- ")));
    }
    for line in values(group) {
        let _ = writeln!(text, "<p>{}</p>", escaped(&line));
    }
    let _ = writeln!(text, "<pre>{}</pre>", escaped(&group.first.text));
    if let Some(smallest) = &answer.smallest {
        let _ = writeln!(
            text,
            "<details><summary>The smallest scenario, {} of {} steps</summary><pre>{}</pre></details>",
            smallest.steps.0,
            smallest.steps.1,
            escaped(&smallest.text)
        );
    }
}

fn escaped(text: &str) -> String {
    printable(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
