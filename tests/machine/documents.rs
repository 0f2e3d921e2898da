//! Tests that the README and the pages of `docs/` are up to date: what they show runs, equals the program, or exists.
//!
//! `docs/contributing.md` lists what is tested for which kind of block. The pages that need a running server are tested in `tests/serve`.
#![cfg(feature = "cli")]

use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use opennck::image::Preset;
use opennck::plant::PlantDefinition;
use opennck::plc::{MACHINE_CONTROL_PANEL_LAYOUT, Programs};
use opennck::scenario::Scenario;

/// The largest README, in bytes: one page.
const LARGEST_README: usize = 10_000;

fn project() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    fs::read_to_string(project().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A block of code between two fences.
struct Block {
    /// Line of its first fence, counted from one.
    line: usize,
    language: String,
    text: String,
}

/// The README or a page.
struct Page {
    path: String,
    /// The text outside of blocks; the lines of blocks are empty.
    prose: String,
    blocks: Vec<Block>,
}

impl Page {
    fn read(path: &str) -> Self {
        let mut page = Self { path: path.to_owned(), prose: String::new(), blocks: Vec::new() };
        let mut open: Option<Block> = None;
        for (index, line) in read(path).lines().enumerate() {
            match (line.strip_prefix("```"), &mut open) {
                (Some(language), None) => {
                    open = Some(Block { line: index + 1, language: language.to_owned(), text: String::new() });
                }
                (Some(_), Some(_)) => page.blocks.extend(open.take()),
                (None, Some(block)) => block.text += &format!("{line}\n"),
                (None, None) => page.prose += line,
            }
            page.prose.push('\n');
        }
        assert!(open.is_none(), "{path}: the last block has no end");
        page
    }

    fn of(&self, language: &str) -> impl Iterator<Item = &Block> {
        self.blocks.iter().filter(move |block| block.language == language)
    }

    fn place(&self, block: &Block) -> String {
        format!("{}:{}", self.path, block.line)
    }

    /// The commands of its shell blocks and pipelines that call the program, each with its place.
    fn commands(&self) -> Vec<(String, String)> {
        let mut commands = Vec::new();
        for block in &self.blocks {
            for (index, line) in block.text.lines().enumerate() {
                let command = match block.language.as_str() {
                    "sh" => line.strip_prefix("opennck "),
                    "yaml" => {
                        let line = line.trim_start().trim_start_matches("- ");
                        line.strip_prefix("run: ").unwrap_or(line).strip_prefix("opennck ")
                    }
                    _ => None,
                };
                let place = format!("{}:{}", self.path, block.line + 1 + index);
                commands.extend(command.map(|command| (place, format!("opennck {command}"))));
            }
        }
        commands
    }
}

impl Block {
    /// The file that the block shows: its first line is a comment with the name.
    fn file(&self) -> Option<&str> {
        // A comment of an NC program begins with `;`, one of a STEP 7 source with `//`.
        let first = self.text.lines().next()?;
        let comment = match self.language.as_str() {
            "nc" => "; ",
            "awl" => "// ",
            _ => "# ",
        };
        first.strip_prefix(comment).filter(|name| !name.contains(' '))
    }

    fn is_scenario(&self) -> bool {
        self.language == "toml" && self.text.lines().any(|line| line.starts_with("title "))
    }
}

/// The README first, then the pages.
fn pages() -> Vec<Page> {
    let mut paths = vec!["README.md".to_owned()];
    let names = fs::read_dir(project().join("docs"))
        .expect("the project has it")
        .map(|entry| entry.expect("the project has it").file_name().into_string().expect("the project has it"));
    paths.extend(names.filter(|name| name.ends_with(".md")).map(|name| format!("docs/{name}")));
    paths.sort();
    paths.iter().map(|path| Page::read(path)).collect()
}

fn page(path: &str) -> Page {
    Page::read(path)
}

fn texts(page: &Page, language: &str) -> Vec<String> {
    page.of(language).map(|block| block.text.clone()).collect()
}

fn print(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_opennck")).args(arguments).output().expect("the project has it");
    String::from_utf8(output.stdout).expect("the project has it")
}

/// The exit code that the comment of a command names, or 0.
fn exit_code(command: &str) -> i32 {
    let said = command.split_once("# exit code ").and_then(|(_, code)| code.chars().next()?.to_digit(10));
    i32::try_from(said.unwrap_or(0)).expect("the project has it")
}

#[test]
fn the_readme_is_one_page() {
    let size = read("README.md").len();
    assert!(size <= LARGEST_README, "{size} bytes: move a section to docs/");
}

#[test]
fn every_scenario_in_the_pages_passes_unless_the_page_says_that_it_fails() {
    let mut count = 0;
    for page in pages() {
        let commands = page.commands();
        for block in page.of("toml").filter(|block| block.is_scenario()) {
            let fails = block.file().is_some_and(|file| {
                commands.iter().any(|(_, command)| exit_code(command) == 1 && command.contains(file))
            });
            let place = page.place(block);
            let cases = Scenario::parse_cases(&block.text, Path::new("page.toml"));
            for scenario in cases.unwrap_or_else(|problem| panic!("{place}: {problem}")) {
                if scenario.plc_process.is_some() || scenario.plc_folder().is_some() {
                    continue; // a command of the page runs it, in a folder with the program
                }
                let prepared = scenario.prepare(scenario.profiles[0], &Programs::ready());
                let finished = prepared.unwrap_or_else(|problem| panic!("{place}: {problem}")).run();
                assert_eq!(finished.failure.is_some(), fails, "{place}: {:?}", finished.failure);
                count += 1;
            }
        }
    }
    assert!(count >= 6, "{count} scenarios");
}

/// Each page has a folder of its own with the files that it shows, and some of the project's.
#[test]
#[cfg(unix)]
fn every_command_in_the_pages_ends_as_the_page_says() {
    let path = format!("{}:{}", folder_of_the_program().display(), std::env::var("PATH").unwrap_or_default());
    let mut count = 0;
    for page in pages() {
        let folder = folder_of(&page);
        for (place, command) in page.commands() {
            // A server is needed: tests/serve.
            if ["opennck s7 ", "opennck serve "].iter().any(|start| command.starts_with(start)) {
                continue;
            }
            if command.contains("session.toml") {
                continue; // the session is recorded by a server
            }
            let output =
                Command::new("sh").args(["-c", &command]).current_dir(&folder).env("PATH", &path).output().unwrap();
            let error = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(exit_code(&command)), "{place}: {command}\n{error}");
            count += 1;
        }
    }
    assert!(count >= 20, "{count} commands");
}

#[cfg(unix)]
fn folder_of_the_program() -> PathBuf {
    Path::new(env!("CARGO_BIN_EXE_opennck")).parent().expect("the project has it").to_owned()
}

#[cfg(unix)]
fn folder_of(page: &Page) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("pages").join(page.path.replace('/', "_"));
    let _ = fs::remove_dir_all(&folder);
    for below in ["golden/jog", "golden/motion", "golden/worked_example", "machine_data", "plc_images"] {
        copy(&project().join(below), &folder.join(below));
    }
    fs::copy(project().join("examples/python_plc/opennck_image.py"), folder.join("opennck_image.py"))
        .expect("the project has it");
    for block in page.of("toml").chain(page.of("python")).chain(page.of("nc")).chain(page.of("awl")) {
        if let Some(file) = block.file() {
            let file = folder.join(file);
            fs::create_dir_all(file.parent().expect("the project has it")).expect("the project has it");
            fs::write(file, &block.text).expect("the project has it");
        }
    }
    folder
}

#[cfg(unix)]
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("the project has it");
    for entry in fs::read_dir(from).expect("the project has it") {
        let entry = entry.expect("the project has it");
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if from.is_dir() {
            copy(&from, &to);
        } else {
            fs::copy(from, to).expect("the project has it");
        }
    }
}

#[test]
fn other_files_in_the_pages_are_read_as_what_they_are() {
    for page in pages() {
        for block in page.of("toml").filter(|block| !block.is_scenario()) {
            let place = page.place(block);
            match block.file() {
                Some("plant.toml") => {
                    PlantDefinition::parse(&block.text, &place).unwrap_or_else(|problem| panic!("{problem}"));
                }
                Some(file) if file.starts_with("plc_images/") => {
                    Preset::parse(&block.text, &place).unwrap_or_else(|problem| panic!("{problem}"));
                    let (_, shown) = block.text.split_once('\n').unwrap();
                    assert_eq!(shown, read(file), "{place}");
                }
                Some(_) | None => {
                    block.text.parse::<toml::Table>().unwrap_or_else(|error| panic!("{place}: {error}"));
                }
            }
        }
    }
}

#[test]
fn all_rust_code_in_the_pages_is_part_of_a_file_that_is_compiled() {
    let mut files = Vec::new();
    for below in ["examples", "tests"] {
        rust_files(&project().join(below), &mut files);
    }
    for page in pages() {
        for block in page.of("rust") {
            assert!(files.iter().any(|file| file.contains(&block.text)), "{}: no such code", page.place(block));
        }
    }
}

fn rust_files(folder: &Path, files: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("the project has it") {
        let path = entry.expect("the project has it").path();
        if path.is_dir() {
            rust_files(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(fs::read_to_string(path).expect("the project has it"));
        }
    }
}

/// Where there is no compiler, nothing is tested.
#[test]
fn code_in_c_and_python_compiles() {
    let compilers: [(&str, &[&str]); 2] = [
        ("c", &["cc", "-std=c11", "-Wall", "-Wextra", "-Werror", "-Wno-sign-compare", "-fsyntax-only", "-x", "c", "-"]),
        ("python", &["python3", "-c", "import sys; compile(sys.stdin.read(), 'page', 'exec')"]),
    ];
    for (language, command) in compilers {
        for page in pages() {
            for block in page.of(language) {
                let compiler = Command::new(command[0]).args(&command[1..]).stdin(Stdio::piped()).spawn();
                let Ok(mut compiler) = compiler else { continue };
                compiler.stdin.take().unwrap().write_all(block.text.as_bytes()).unwrap();
                assert!(compiler.wait().unwrap().success(), "{}", page.place(block));
            }
        }
    }
}

#[test]
fn every_row_in_the_readme_is_in_the_worked_example() {
    let output = print(&[]);
    for row in texts(&page("README.md"), "text")[0].lines() {
        assert!(output.lines().any(|line| line == row), "not in the output of `opennck`: {row}");
    }
}

#[test]
fn the_test_command_of_the_readme_is_the_one_of_the_ci() {
    let commands = texts(&page("README.md"), "sh");
    let test = commands[0].lines().find(|line| line.starts_with("cargo test")).unwrap();
    assert!(read(".ci/run").lines().any(|line| line == format!("step {test} --locked")), "{test}");
}

#[test]
fn the_crate_in_the_pages_is_the_example_word_for_word() {
    let example = read("examples/gantry_in_ci/tests/gantry.rs");
    let (head, code) = example.split_once("\n\n").unwrap();
    assert!(head.starts_with("//! "));
    assert_eq!(texts(&page("docs/plc_in_rust.md"), "rust")[0], code);
    let manifest = read("examples/gantry_in_ci/Cargo.toml");
    let (_, dependencies) = manifest.split_once("[dev-dependencies]").unwrap();
    assert!(texts(&page("docs/plc_in_rust.md"), "toml")[0].contains(dependencies), "{dependencies}");
}

#[test]
fn the_flowcharts_are_the_ones_that_the_program_prints() {
    let charts = texts(&page("docs/flowcharts.md"), "mermaid");
    let drawn = ["gantry", "approach", "exchange"].map(|chart| print(&["flowchart", chart]));
    assert_eq!(charts, drawn);
}

#[test]
fn the_layout_of_the_panel_is_the_one_of_the_program() {
    assert_eq!(texts(&page("docs/plc_programs.md"), "text"), [MACHINE_CONTROL_PANEL_LAYOUT]);
}

#[test]
fn the_pages_name_every_built_in_program() {
    let page = page("docs/plc_programs.md");
    for name in Programs::ready().names() {
        assert!(page.prose.contains(&format!("\n| `{name}` |")), "{name}");
    }
}

/// The keys that the reader of `plant.toml` takes.
#[test]
fn the_pages_name_every_key_of_a_plant() {
    let text = read("docs/machine_folder.md");
    let sources = ["definition", "hold", "leadscrew"].map(|name| read(&format!("src/plant/{name}.rs")));
    let mut keys = vec!["encoder1", "encoder2"];
    for source in &sources {
        let source = source.split("#[cfg(test)]").next().unwrap();
        for before in [".take(\"", "required(&mut table, \""] {
            keys.extend(source.split(before).skip(1).filter_map(|rest| rest.split('"').next()));
        }
    }
    assert!(keys.len() > 20, "{keys:?}");
    for key in keys {
        let said = [format!("`{key}`"), format!("[X.{key}]"), format!("[{key}]"), format!("[{key}.1]")];
        assert!(said.iter().any(|said| text.contains(said)), "docs/machine_folder.md does not describe `{key}`");
    }
}

#[test]
#[cfg(feature = "s7")]
fn the_pages_name_every_option_of_the_server() {
    let (help, text) = (print(&["serve", "--help"]), read("docs/serving.md"));
    let options: Vec<&str> =
        help.lines().filter_map(|line| line.trim_start().strip_prefix("--")?.split(' ').next()).collect();
    assert!(options.len() > 20, "{options:?}");
    for option in options {
        assert!(text.contains(&format!("--{option}")), "docs/serving.md does not name --{option}");
    }
}

// Links.

/// The targets of the links in a text without blocks, each with its line.
fn links(prose: &str) -> Vec<(usize, String)> {
    let mut links = Vec::new();
    for (index, line) in prose.lines().enumerate() {
        // Code between backticks has no links.
        let outside: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
        let targets = outside.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
        links.extend(targets.map(|(target, _)| (index + 1, target.to_owned())));
    }
    links
}

/// The anchors of a page's headings, as code hosts and mdBook make them.
fn anchors(page: &Page) -> BTreeSet<String> {
    let headings = page.prose.lines().filter(|line| line.starts_with('#'));
    headings
        .map(|line| {
            let text = line.trim_start_matches('#').trim().to_lowercase();
            let kept = text.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        })
        .collect()
}

/// Links of the pages stay in `docs/`, so that they are also right in the book.
#[test]
fn every_link_has_a_target() {
    let mut wrong = Vec::new();
    for page in pages() {
        let folder = Path::new(&page.path).parent().unwrap().to_owned();
        for (line, link) in links(&page.prose) {
            if link.starts_with("https://") {
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = if file.is_empty() { page.path.clone() } else { folder.join(file).display().to_string() };
            let outside = !folder.as_os_str().is_empty() && (file.contains('/') || file.contains(".."));
            let missing = !project().join(&target).exists();
            if outside || missing || !anchor.is_empty() && !anchors(&Page::read(&target)).contains(anchor) {
                wrong.push(format!("{}:{line}: {link}", page.path));
            }
        }
    }
    assert!(wrong.is_empty(), "links without a target, or out of docs/:\n{}", wrong.join("\n"));
}

/// Files and folders of the project between backticks. (`<` and `…` stand for names of the reader's own.)
#[test]
fn every_file_that_the_pages_name_exists() {
    let folders =
        ["src/", "tests/", "golden/", "docs/", "examples/", "machine_data/", "plc_images/", "benches/", "fuzz/"];
    let mut count = 0;
    for page in pages() {
        for (index, line) in page.prose.lines().enumerate() {
            let names = line.split('`').skip(1).step_by(2).flat_map(str::split_whitespace);
            for name in names.filter(|name| folders.iter().any(|folder| name.starts_with(folder))) {
                let scenario = project().join(format!("{name}.toml"));
                let there = name.contains(['<', '…', '*', '=']) || project().join(name).exists() || scenario.exists();
                assert!(there, "{}:{}: there is no {name}", page.path, index + 1);
                count += 1;
            }
        }
    }
    assert!(count > 50, "{count} names");
}

#[test]
fn the_map_has_every_module() {
    let map = page("docs/contributing.md").prose;
    for entry in fs::read_dir(project().join("src")).unwrap() {
        let path = entry.unwrap().path();
        let name = format!("`src/{}`", path.file_name().unwrap().to_str().unwrap());
        assert!(!path.is_dir() || map.contains(&name), "docs/contributing.md has no {name}");
    }
}

/// A `|` in a cell would begin a new one.
#[test]
fn every_row_of_a_table_has_the_columns_of_its_head() {
    for page in pages() {
        let mut columns = None;
        for (index, line) in page.prose.lines().enumerate() {
            let cells = line.starts_with('|').then(|| line.replace("\\|", "").matches('|').count());
            assert!(columns.is_none() || cells.is_none() || columns == cells, "{}:{}: {line}", page.path, index + 1);
            columns = cells;
        }
    }
}

#[test]
fn the_summary_lists_every_page_once() {
    let mut listed: Vec<String> = links(&page("docs/SUMMARY.md").prose).into_iter().map(|(_, link)| link).collect();
    listed.sort();
    let mut expected: Vec<String> =
        pages().iter().filter_map(|page| Some(page.path.strip_prefix("docs/")?.to_owned())).collect();
    expected.retain(|name| name != "SUMMARY.md");
    assert_eq!(listed, expected);
    let book: toml::Table = read("docs/book.toml").parse().unwrap();
    assert_eq!(book["book"]["src"].as_str(), Some("."));
}

#[test]
fn wrong_links_and_headings_are_found() {
    let prose = "# A `b` & c: d_e\n[x](y.md#a-b--c-d_e) and `[n](no.md)`, [z](https://z)\n";
    let page = Page { path: "x.md".to_owned(), prose: prose.to_owned(), blocks: Vec::new() };
    assert_eq!(links(prose), [(2, "y.md#a-b--c-d_e".to_owned()), (2, "https://z".to_owned())]);
    assert_eq!(anchors(&page).into_iter().collect::<Vec<_>>(), ["a-b--c-d_e"]);
}

// Decisions.

/// A row of a decision.
struct Decision {
    /// `E-01`, also of a row `E-01, REF`.
    id: String,
    modules: Vec<String>,
    tests: Vec<String>,
}

/// The rows with an ID, in their order.
fn decisions() -> Vec<Decision> {
    let page = page("docs/decisions.md").prose;
    let rows = page
        .lines()
        .filter(|line| line.starts_with('|'))
        .map(|line| line.trim_matches('|').split(" | ").map(str::trim).collect::<Vec<_>>());
    rows.filter_map(|row| {
        let id = row[0].split(',').next().filter(|id| is_id(id))?.to_owned();
        let [_, _, _, _, modules, tests] = row.as_slice() else { panic!("a decision needs six columns: {row:?}") };
        let names = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect();
        Some(Decision { id, modules: names(modules), tests: names(tests) })
    })
    .collect()
}

/// `E-01`.
fn is_id(text: &str) -> bool {
    let Some((letter, number)) = text.split_once('-') else { return false };
    ["E", "O", "C", "P", "K", "X", "S"].contains(&letter)
        && number.len() == 2
        && number.bytes().all(|byte| byte.is_ascii_digit())
}

#[test]
fn decisions_are_sorted_and_name_modules_and_tests_that_exist() {
    let decisions = decisions();
    for letter in ["E", "O", "C", "P", "K", "X", "S"] {
        let ids: Vec<&str> = decisions.iter().map(|row| row.id.as_str()).filter(|id| id.starts_with(letter)).collect();
        assert!(ids.is_sorted() && !ids.is_empty(), "sort by ID: {ids:?}");
    }
    let mut sources = Vec::new();
    for below in ["src", "tests"] {
        rust_files(&project().join(below), &mut sources);
    }
    let exists = |path: String| project().join(path).exists();
    for Decision { id, modules, tests } in decisions {
        assert!(!modules.is_empty() && !tests.is_empty(), "{id} needs a module and a test");
        for module in modules {
            let path = format!("src/{}", module.replace("::", "/"));
            assert!(exists(path.clone()) || exists(format!("{path}.rs")), "{id}: there is no {path}");
        }
        for test in tests {
            let head = format!("fn {test}(");
            let there = exists(format!("{test}.toml")) || sources.iter().any(|source| source.contains(&head));
            assert!(there, "{id}: there is no scenario and no test `{test}`");
        }
    }
}

/// Decisions that the sources, scenarios and causes name.
#[test]
fn every_decision_that_is_cited_has_a_row() {
    let ids: BTreeSet<String> = decisions().into_iter().map(|row| row.id).collect();
    let mut files = Vec::new();
    rust_files(&project().join("src"), &mut files);
    for area in fs::read_dir(project().join("golden")).unwrap() {
        // A machine may be stored beside its scenarios.
        let entries = fs::read_dir(area.unwrap().path()).unwrap().map(|entry| entry.unwrap().path());
        files.extend(entries.filter(|path| path.is_file()).map(|path| fs::read_to_string(path).unwrap()));
    }
    let words = files.iter().flat_map(|text| text.split(|c: char| !c.is_ascii_alphanumeric() && c != '-'));
    let cited: BTreeSet<&str> = words.filter(|word| is_id(word)).collect();
    let missing: Vec<_> = cited.iter().filter(|id| !ids.contains(**id)).collect();
    assert!(missing.is_empty() && cited.len() > 30, "without a row in docs/decisions.md: {missing:?}");
}

/// The page about NC programs shows what `nc check` prints.
#[test]
fn the_findings_of_nc_check_are_those_that_the_page_shows() {
    let page = page("docs/nc_programs.md");
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("nc_check");
    fs::create_dir_all(&folder).expect("the folder of the test is writable");
    let mut arguments = vec!["nc", "check"];
    for block in page.of("nc") {
        let file = block.file().expect("its first line names the file");
        fs::write(folder.join(file), &block.text).expect("the folder of the test is writable");
        arguments.push(file);
    }
    let output = Command::new(env!("CARGO_BIN_EXE_opennck")).args(&arguments).current_dir(&folder).output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), texts(&page, "text")[0]);
    assert_eq!(output.status.code(), Some(1));
}

/// A picture in a page is what the command below it writes. With OPENNCK_ACCEPT=1 this test writes it.
#[test]
fn pictures_are_those_of_their_commands() {
    let mut count = 0;
    for page in pages() {
        let pictures = links(&page.prose).into_iter().map(|(_, link)| link).filter(|link| link.ends_with(".svg"));
        for picture in pictures {
            let option = format!("--svg {picture}");
            let commands = page.commands();
            let command = commands.iter().find(|(_, command)| command.contains(&option));
            let (_, command) = command.unwrap_or_else(|| panic!("{}: no command writes {picture}", page.path));
            let written = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(&picture);
            let words: Vec<_> = command.split_whitespace().skip(1).map(str::to_owned).collect();
            let words =
                words.iter().map(|word| if *word == picture { written.display().to_string() } else { word.clone() });
            let mut run = Command::new(env!("CARGO_BIN_EXE_opennck"));
            let output = run.args(words).current_dir(project()).output().expect("the project has it");
            assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
            let (written, kept) = (fs::read_to_string(written).expect("it was written"), format!("docs/{picture}"));
            if std::env::var_os("OPENNCK_ACCEPT").is_some() {
                fs::write(project().join(&kept), &written).expect("the project can be written");
            }
            assert!(read(&kept) == written, "{kept} is old: run this test once with OPENNCK_ACCEPT=1");
            count += 1;
        }
    }
    assert!(count >= 1);
}
