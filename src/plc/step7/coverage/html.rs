//! Coverage as a page: the contacts that never changed first, then what never ran, then the sources.

use std::fmt::Write;

use super::{Counts, Coverage, StatementCoverage, percent};

const STYLE: &str = "body{font:14px/1.4 sans-serif;margin:2em;color:#222;background:#fff}table{border-collapse:collapse}\
    td,th{padding:2px 10px;text-align:left;vertical-align:top}th{border-bottom:1px solid #999}\
    pre{margin:0;font:13px/1.35 monospace}.n{color:#888;text-align:right}.no{background:#fdd}.part{background:#ffefc0}.yes{background:#e4f6e4}\
    .r{color:#666;white-space:nowrap}a{color:#04c}\
    @media(prefers-color-scheme:dark){body{color:#ddd;background:#181818}.no{background:#522}.part{background:#4a3c10}.yes{background:#1e3a22}a{color:#8bf}.n,.r{color:#999}}";

impl Coverage {
    /// Several programs as an HTML page without other files.
    #[must_use]
    pub fn html(all: &[Self]) -> String {
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>Coverage</title><style>{STYLE}</style></head>\n<body>\n"
        );
        for (index, one) in all.iter().enumerate() {
            page += &one.section(index);
        }
        page + "</body>\n</html>\n"
    }

    fn section(&self, program: usize) -> String {
        let Counts { statements, networks, branches, contacts } = self.counts();
        let mut page = format!(
            "<h1>Coverage of {}</h1>\n<table>\n<tr><th></th><th>covered</th><th>all</th><th></th></tr>\n",
            escaped(&self.program)
        );
        for ([done, all], noun) in [
            (statements, "statements that ran"),
            (networks, "networks that ran"),
            (branches, "branches of conditional jumps, calls and ends"),
            (contacts, "contacts that were true and false"),
        ] {
            let percent = percent([done, all]);
            let _ = writeln!(page, "<tr><td>{noun}</td><td>{done}</td><td>{all}</td><td>{percent} %</td></tr>");
        }
        page += "</table>\n";
        if !self.basic_program.is_empty() {
            let blocks = escaped(&self.basic_program.join(", "));
            let _ = writeln!(page, "<p>Built in, not counted: {blocks}</p>");
        }
        let unchanged: Vec<_> = self.unchanged().collect();
        self.list(program, &mut page, "Contacts that never changed", &unchanged, |one| {
            if one.contact.is_some_and(|[_, yes]| yes) { "always 1" } else { "always 0" }
        });
        let half: Vec<_> =
            self.statements.iter().filter(|one| one.ran && one.branch.is_some_and(|[no, yes]| no != yes)).collect();
        self.list(program, &mut page, "Branches with one side", &half, |one| {
            if one.branch.is_some_and(|[_, yes]| yes) { "always taken" } else { "never taken" }
        });
        let never: Vec<_> = self.statements.iter().filter(|one| !one.ran).collect();
        self.list(program, &mut page, "Statements that never ran", &never, |_| "");
        for (file, ((path, text), lines)) in self.files.iter().zip(self.by_line()).enumerate() {
            if lines.is_empty() {
                continue;
            }
            let _ = writeln!(page, "<h2>{}</h2>\n<table>", escaped(path));
            for (number, line) in (1..).zip(text.lines()) {
                let (class, remark) = lines.get(&number).map_or(("", String::new()), |own| judged(own));
                let _ = writeln!(
                    page,
                    "<tr id=\"p{program}f{file}l{number}\" class=\"{class}\"><td class=\"n\">{number}</td><td><pre>{}</pre></td><td class=\"r\">{remark}</td></tr>",
                    escaped(line)
                );
            }
            page += "</table>\n";
        }
        page
    }

    fn list(
        &self,
        program: usize,
        page: &mut String,
        title: &str,
        of: &[&StatementCoverage],
        remark: fn(&StatementCoverage) -> &str,
    ) {
        let _ = writeln!(page, "<h2>{title}: {}</h2>", of.len());
        if of.is_empty() {
            return;
        }
        *page += "<table>\n<tr><th>statement</th><th></th><th>block</th><th>network</th><th>line</th></tr>\n";
        for one in of {
            let (text, path) = (escaped(self.text(one)), escaped(&self.files[one.file].0));
            let StatementCoverage { file, line, block, network, .. } = one;
            let remark = remark(one);
            let _ = writeln!(
                page,
                "<tr><td><pre>{text}</pre></td><td>{remark}</td><td>{block}</td><td>{network}</td><td><a href=\"#p{program}f{file}l{line}\">{path}:{line}</a></td></tr>"
            );
        }
        *page += "</table>\n";
    }
}

/// The class of a line, and what is to be said about its statements.
fn judged(statements: &[&StatementCoverage]) -> (&'static str, String) {
    if !statements.iter().any(|one| one.ran) {
        return ("no", String::new());
    }
    let mut remarks = Vec::new();
    for one in statements {
        match (one.ran, one.contact, one.branch) {
            (false, ..) => remarks.push(format!("statement {} never ran", one.statement)),
            (true, Some([true, false]), _) => remarks.push("always 0".to_owned()),
            (true, Some([false, true]), _) => remarks.push("always 1".to_owned()),
            (true, _, Some([true, false])) => remarks.push("never taken".to_owned()),
            (true, _, Some([false, true])) => remarks.push("always taken".to_owned()),
            _ => {}
        }
    }
    (if remarks.is_empty() { "yes" } else { "part" }, remarks.join(", "))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
