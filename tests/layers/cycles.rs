//! Checks that the imports between the files of `src` have no cycle. A reader can then read the files in an order in which each file
//! follows the files that it needs.
//!
//! An import is a `use` or a path that reaches an item of another file. A name belongs to the file that defines it, even if a `mod.rs`
//! re-exports it: `super::Row` is an import of the sibling that contains `Row`, not of the parent. Declaring or re-exporting a child is not
//! an import unless the parent itself uses the name. A method call is not an import. Tests are ignored.
//!
//! The check reads the text without a compiler: tokens without comments and strings, names by their `use`. This covers all code of this
//! project. It does not follow a `use` with `*`.

use std::collections::{BTreeMap, BTreeSet};

use crate::{report, rust};

/// Accepted cycles: files, or folders with all files below them, and the reason.
const CYCLES: &[(&[&str], &str)] = &[];

#[test]
fn imports_have_no_cycle() {
    let files: Vec<_> = rust("src").into_iter().map(|file| (file.path, file.text)).collect();
    let known: Vec<_> = CYCLES.iter().map(|(files, _)| *files).collect();
    report(findings(&files, &known));
}

/// Cycles that are not in the list, and entries of the list without a cycle.
fn findings(files: &[(String, String)], known: &[&[&str]]) -> Vec<String> {
    let edges = Sources::new(files).edges();
    let cycles = cycles(&edges);
    let holds = |entry: &[&str], cycle: &BTreeSet<&str>| {
        cycle.iter().all(|file| entry.iter().any(|part| file == part || part.ends_with('/') && file.starts_with(part)))
    };
    let mut findings = Vec::new();
    for cycle in &cycles {
        if known.iter().any(|entry| holds(entry, cycle)) {
            continue;
        }
        let mut finding = format!(
            "an import cycle of {} files: move the shared items into a file that imports none of them",
            cycle.len()
        );
        for ((from, to), (line, name)) in &edges {
            if cycle.contains(from) && cycle.contains(to) {
                finding += &format!("\n    {from}:{line}: imports `{name}` of {to}");
            }
        }
        findings.push(finding);
    }
    for entry in known {
        if !cycles.iter().any(|cycle| holds(entry, cycle)) {
            findings.push(format!("{}: has no cycle: remove it from the list", entry.join(", ")));
        }
    }
    findings
}

/// Importing file and imported file, with the line of the first import and the imported name.
type Edges<'a> = BTreeMap<(&'a str, &'a str), (usize, String)>;

/// Groups of two or more files that reach each other.
fn cycles<'a>(edges: &Edges<'a>) -> Vec<BTreeSet<&'a str>> {
    let mut reached: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for &(from, _) in edges.keys() {
        let mut open = vec![from];
        let seen = reached.entry(from).or_default();
        while let Some(file) = open.pop() {
            let next = edges.range((file, "")..).map(|(edge, _)| *edge).take_while(|edge| edge.0 == file);
            open.extend(next.map(|edge| edge.1).filter(|&file| seen.insert(file)));
        }
    }
    let mut cycles = BTreeSet::new();
    for (file, below) in reached.iter().filter(|(file, below)| below.contains(*file)) {
        cycles.insert(
            below.iter().filter(|other| reached.get(*other).is_some_and(|back| back.contains(file))).copied().collect(),
        );
    }
    cycles.into_iter().collect()
}

/// A path in the source text.
#[derive(Debug)]
struct Written {
    line: usize,
    /// The number of modules inside its file that contain it.
    depth: usize,
    path: Vec<String>,
    /// The name that a `use` defines; `None` for a path in the code.
    name: Option<String>,
    /// Whether a `use` re-exports the name.
    is_public: bool,
}

struct Source<'a> {
    path: &'a str,
    module: Vec<String>,
    written: Vec<Written>,
    /// Single names in the code, outside every `use`.
    names: BTreeSet<String>,
}

/// The file that a path reaches, and whether the path is the whole module.
type Reached = (usize, bool);

struct Sources<'a> {
    sources: Vec<Source<'a>>,
    modules: BTreeMap<Vec<String>, usize>,
}

impl<'a> Sources<'a> {
    fn new(files: &'a [(String, String)]) -> Self {
        let is_test = |path: &str| path.ends_with("/tests.rs") || path.contains("/tests/") || path == "src/main.rs";
        let files = files.iter().filter(|(path, _)| !is_test(path));
        let sources: Vec<_> = files.map(|(path, text)| read(path, text)).collect();
        let modules = sources.iter().enumerate().map(|(index, source)| (source.module.clone(), index)).collect();
        Self { sources, modules }
    }

    fn edges(&self) -> Edges<'a> {
        let mut edges = BTreeMap::new();
        for source in &self.sources {
            for written in &source.written {
                let Some((file, is_module)) = self.reached(source, written) else { continue };
                let (from, to) = (source.path, self.sources[file].path);
                let child = self.sources[file].module.starts_with(&source.module);
                let counts = match &written.name {
                    Some(name) if written.is_public && child => source.names.contains(name) && !is_module,
                    Some(_) => !is_module,
                    None => true,
                };
                if counts && from != to {
                    edges.entry((from, to)).or_insert_with(|| (written.line, written.path.join("::")));
                }
            }
        }
        edges
    }

    fn reached(&self, source: &Source<'_>, written: &Written) -> Option<Reached> {
        let ups = written.path.iter().take_while(|part| *part == "super").count();
        if (1..=written.depth).contains(&ups) {
            return self.item(&source.module, &written.path[ups..], 0);
        }
        self.start(&source.module, &written.path[ups.min(written.depth)..], 0)
    }

    /// Resolves a path: the first part in the current module, each following part in the module before it.
    fn start(&self, module: &[String], path: &[String], turn: usize) -> Option<Reached> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => self.item(&[], rest, turn),
            "self" => self.item(module, rest, turn),
            "super" => {
                let (parent, ups) =
                    (&module[..module.len().checked_sub(1)?], rest.iter().take_while(|part| *part == "super"));
                self.item(&parent[..parent.len() - ups.clone().count()], &rest[ups.count()..], turn)
            }
            name if self.is_known(module, name) => self.item(module, path, turn),
            _ => None,
        }
    }

    fn item(&self, module: &[String], path: &[String], turn: usize) -> Option<Reached> {
        let file = self.modules.get(module).copied();
        let Some((name, rest)) = path.split_first() else { return Some((file?, true)) };
        let child = [module, std::slice::from_ref(name)].concat();
        let passed =
            file.and_then(|file| self.sources[file].written.iter().find(|written| written.name.as_ref() == Some(name)));
        match passed {
            _ if self.modules.contains_key(&child) && (!rest.is_empty() || passed.is_none()) => {
                self.item(&child, rest, turn)
            }
            Some(passed) if passed.path.len() > 1 && turn < 9 => {
                self.start(module, &[&passed.path, rest].concat(), turn + 1)
            }
            _ => Some((file?, false)),
        }
    }

    fn is_known(&self, module: &[String], name: &str) -> bool {
        let child = [module, &[name.to_owned()]].concat();
        let named = |written: &Written| written.name.as_deref() == Some(name) && written.path[0] != name;
        self.modules.contains_key(&child) || self.sources[self.modules[module]].written.iter().any(named)
    }
}

fn read<'a>(path: &'a str, text: &str) -> Source<'a> {
    let inside = path.trim_start_matches("src/").trim_end_matches(".rs").trim_end_matches("/mod");
    let module = inside.split('/').filter(|part| *part != "lib").map(str::to_owned).collect();
    let tokens = without_tests(&tokens(text));
    let mut source = Source { path, module, written: Vec::new(), names: BTreeSet::new() };
    let mut braces = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let before = at.checked_sub(1).map_or("", |before| tokens[before].1.as_str());
        let word = |at: usize| tokens.get(at).map_or("", |token: &(usize, String)| token.1.as_str());
        let (line, depth) = (tokens[at].0, braces.iter().filter(|is_module| **is_module).count());
        match word(at) {
            "{" => braces.push(at > 1 && word(at - 2) == "mod"),
            "}" => drop(braces.pop()),
            "use" if word(at + 1) != "<" => {
                let start = source.written.len();
                at = tree(&tokens, at + 1, &[], &mut source.written);
                for written in &mut source.written[start..] {
                    written.depth = depth;
                    written.is_public = before == "pub" || before == ")";
                }
            }
            // After `pub(in`, the path is a visibility and not an import.
            "crate" if before == "in" => {}
            first if is_name(first) && !["::", ".", "mod"].contains(&before) => {
                let mut path = vec![first.to_owned()];
                while word(at + 1) == "::" && is_name(word(at + 2)) {
                    path.push(word(at + 2).to_owned());
                    at += 2;
                }
                if before != "fn" {
                    source.names.insert(path[0].clone());
                }
                if path.len() > 1 {
                    source.written.push(Written { line, depth, path, name: None, is_public: false });
                }
            }
            _ => {}
        }
        at += 1;
    }
    source
}

/// Reads one tree of a `use`, and returns the index of the token that ends it.
fn tree(tokens: &[(usize, String)], start: usize, before: &[String], written: &mut Vec<Written>) -> usize {
    let mut path = before.to_vec();
    let mut name = None;
    let mut at = start;
    while let Some((line, token)) = tokens.get(at) {
        match token.as_str() {
            "{" => {
                while tokens[at].1 != "}" {
                    at = tree(tokens, at + 1, &path, written);
                }
                path.clear();
            }
            "as" => {
                at += 1;
                name = Some(tokens[at].1.clone());
            }
            "," | "}" | ";" => {
                if path.last().is_some_and(|last| last == "self") && path.len() > 1 {
                    path.pop();
                }
                if path.len() > before.len() || path.last() != before.last() {
                    let name = name.or_else(|| path.last().cloned());
                    written.push(Written { line: *line, depth: 0, path, name, is_public: false });
                }
                return at;
            }
            part if is_name(part) => path.push(part.to_owned()),
            _ => {}
        }
        at += 1;
    }
    at
}

fn is_name(token: &str) -> bool {
    token.starts_with(|first: char| first.is_alphabetic() || first == '_')
}

/// Names, `::` and single characters, each with its line; without comments, strings, characters, lifetimes and the `$` of a macro.
fn tokens(text: &str) -> Vec<(usize, String)> {
    let letters: Vec<char> = text.chars().collect();
    let peek = |at: usize| letters.get(at).copied().unwrap_or('\n');
    let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    let (mut tokens, mut line, mut at) = (Vec::new(), 1, 0);
    while at < letters.len() {
        let start = at;
        match (peek(at), peek(at + 1)) {
            ('/', '/') => {
                while at < letters.len() && peek(at) != '\n' {
                    at += 1;
                }
            }
            ('r', '"' | '#') if (at + 1..).find(|at| peek(*at) != '#').is_some_and(|at| peek(at) == '"') => {
                let marks = (at + 1..).take_while(|at| peek(*at) == '#').count();
                at += 2 + marks;
                while at < letters.len() && !(peek(at) == '"' && (1..=marks).all(|mark| peek(at + mark) == '#')) {
                    at += 1;
                }
                at += 1 + marks;
            }
            ('"', _) => {
                at += 1;
                while at < letters.len() && peek(at) != '"' {
                    at += if peek(at) == '\\' { 2 } else { 1 };
                }
                at += 1;
            }
            ('\'', '\\') => {
                at = (at + 3..letters.len()).find(|at| peek(*at) == '\'').map_or(letters.len(), |end| end + 1);
            }
            ('\'', _) if peek(at + 2) == '\'' => at += 3,
            ('\'', _) => at = (at + 1..).find(|at| !is_word(peek(*at))).unwrap_or(at),
            (':', ':') => {
                tokens.push((line, "::".to_owned()));
                at += 2;
            }
            ('$', _) => at += 1,
            ('b', '"' | '\'') => at += 1,
            (first, _) if is_word(first) => {
                at = (at..).find(|at| !is_word(peek(*at))).unwrap_or(at);
                tokens.push((line, letters[start..at].iter().collect()));
            }
            (sign, _) => {
                if !sign.is_whitespace() {
                    tokens.push((line, sign.to_string()));
                }
                at += 1;
            }
        }
        line += letters[start..at.min(letters.len())].iter().filter(|letter| **letter == '\n').count();
    }
    tokens
}

/// The tokens without the items after `#[cfg(test)]`.
fn without_tests(tokens: &[(usize, String)]) -> Vec<(usize, String)> {
    let mark = ["#", "[", "cfg", "(", "test", ")", "]"];
    let is_mark = |at: usize| tokens[at..].iter().map(|token| token.1.as_str()).take(mark.len()).eq(mark);
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if !is_mark(at) {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        at += mark.len();
        let (mut depth, mut is_use) = (0, false);
        while let Some((_, token)) = tokens.get(at) {
            at += 1;
            is_use |= token == "use";
            match token.as_str() {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ => {}
            }
            if depth == 0 && (token == ";" || token == "}" && !is_use) {
                break;
            }
        }
    }
    kept
}

// Tests of the check.

fn found(files: &[(&str, &str)], known: &[&[&str]]) -> Vec<String> {
    let files: Vec<_> = files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect();
    findings(&files, known)
}

#[test]
fn two_siblings_that_import_each_other_through_their_parent_are_a_cycle() {
    let parent = ("src/a/mod.rs", "mod b;\nmod c;\npub use b::B;\npub use c::{C, other as renamed};");
    let b = ("src/a/b.rs", "//! B.\nuse super::renamed;\npub struct B;");
    let c = ("src/a/c.rs", "pub fn other() -> crate::a::B {}\npub struct C;");
    assert_eq!(
        found(&[parent, b, c], &[]),
        ["an import cycle of 2 files: move the shared items into a file that imports none of them\n    \
          src/a/b.rs:2: imports `super::renamed` of src/a/c.rs\n    \
          src/a/c.rs:1: imports `crate::a::B` of src/a/b.rs"]
    );
}

#[test]
fn a_parent_imports_a_child_if_it_uses_the_name_and_not_if_it_re_exports_it() {
    let b = ("src/a/b.rs", "use super::Whole;\npub struct B;");
    let finds = |parent| found(&[("src/a/mod.rs", parent), b], &[]).len();
    assert_eq!(finds("mod b;\npub use b::B;\npub struct Whole;"), 0);
    assert_eq!(finds("mod b;\npub use b::B;\npub struct Whole(B);"), 1);
    assert_eq!(finds("mod b;\nuse b::B;\npub struct Whole(B);"), 1);
    assert_eq!(finds("mod b;\npub struct Whole(b::B);"), 1);
    assert_eq!(finds("pub mod b;\npub use b::B;\npub struct Whole(Kind::B); fn B() {}"), 0);
}

#[test]
fn cycles_of_three_files_and_paths_through_a_module_are_found() {
    let a = ("src/a.rs", "use crate::{b, c as d};\npub fn f() { b::g() }");
    let b = ("src/b.rs", "pub fn g() { let x = '\"'; crate::c::h::<u8>() }");
    let c = ("src/c.rs", "pub fn h<'a, T>() { let _ = r#\"\"\"#; super::a::f() }");
    let findings = found(&[a, b, c], &[]);
    assert_eq!(findings.len(), 1);
    assert!(findings[0].starts_with("an import cycle of 3 files"), "{findings:?}");
    assert!(found(&[a, b], &[]).is_empty());
}

#[test]
fn tests_comments_strings_and_inner_modules_make_no_cycle() {
    let a = ("src/a.rs", "use crate::b::B;\npub struct A;");
    let finds = |text| found(&[a, ("src/b.rs", text)], &[]).len();
    assert_eq!(finds("pub struct B(crate::a::A);"), 1);
    assert_eq!(finds("#[cfg(test)]\nmod tests {\n    use crate::a::{A};\n    fn f() {}\n}\npub struct B;"), 0);
    assert_eq!(finds("#[cfg(test)]\nuse crate::a::{A};\npub struct B;"), 0);
    assert_eq!(finds("/// As `crate::a::A`.\npub struct B;\nconst TEXT: &str = \"crate::a::A\";"), 0);
    assert_eq!(finds("pub(in crate::a) struct B;\nmod a { use super::B; pub struct A; }"), 0);
    assert_eq!(found(&[a, ("src/b/mod.rs", "pub struct B;"), ("src/b/tests.rs", "use crate::a::A;")], &[]).len(), 0);
}

#[test]
fn the_list_accepts_a_cycle_and_an_entry_without_a_cycle_is_found() {
    let files = [("src/a/b.rs", "use super::c::C;\npub struct B;"), ("src/a/c.rs", "use super::b::B;\npub struct C;")];
    let parent = ("src/a/mod.rs", "mod b;\nmod c;");
    let files = [files[0], files[1], parent];
    assert!(found(&files, &[&["src/a/"]]).is_empty());
    assert!(found(&files, &[&["src/a/b.rs", "src/a/c.rs"]]).is_empty());
    assert_eq!(found(&files, &[&["src/a/b.rs"]]).len(), 2);
    assert_eq!(found(&[parent], &[&["src/a/"]]), ["src/a/: has no cycle: remove it from the list"]);
}
