//! The trace as a timing diagram in the style of a manual.
//!
//! Coordinates are whole tenths of a pixel, so that the same trace gives the same bytes on every computer. Widths of texts are estimated
//! for a monospaced font.

mod drawing;
mod legend;
mod plot;
mod rows;
mod scale;
mod style;

use super::waves::{WaveKind, Waves};
use super::{Head, Limit};
use drawing::{Drawing, GAP, LETTER, MARGIN, SMALL_LETTER, WIDTH, escaped, px, width_of, wrapped};
use legend::Legend;
use scale::Scale;

/// The complete file.
pub(super) fn document(waves: &Waves, head: &Head) -> String {
    let names = waves.rows.iter().map(|wave| width_of(&rows::name(wave), LETTER)).max().unwrap_or(0);
    let beside = waves.rows.iter().filter(|wave| wave.kind != WaveKind::Alarm);
    let beside = beside.map(|wave| width_of(&wave.beside, SMALL_LETTER)).max().unwrap_or(0);
    let left = (MARGIN + names + 120 + beside + GAP).clamp(2400, WIDTH / 2);
    let scale = Scale::new(waves, left, WIDTH - MARGIN);
    let mut drawing = Drawing { text: String::new(), y: MARGIN, left };
    title(&mut drawing, head);
    let legend = Legend::new(waves);
    let top = drawing.y;
    drawing.y += legend.lane_height(&scale);
    let first_row = drawing.y;
    // Lines through all rows are drawn below the rows, but their lower end is known only here.
    let bottom = first_row + rows::height(waves);
    scale.draw_grid(&mut drawing, first_row, bottom);
    legend.draw_flags(&mut drawing, &scale, top, bottom);
    rows::draw(&mut drawing, waves, &scale);
    scale.draw_breaks(&mut drawing, first_row, bottom);
    drawing.y = bottom;
    scale.draw_axis(&mut drawing);
    legend.draw(&mut drawing, waves);
    file(&drawing, head)
}

/// Curves in panels, each with its own scale: the number of its rows, in order, and its limits.
pub(super) fn plot(waves: &Waves, panels: &[(usize, &[Limit])], head: &Head) -> String {
    let scale = Scale::new(waves, plot::LEFT, WIDTH - MARGIN);
    let mut drawing = Drawing { text: String::new(), y: MARGIN, left: plot::LEFT };
    title(&mut drawing, head);
    let legend = Legend::new(waves);
    let top = drawing.y;
    drawing.y += legend.lane_height(&scale);
    let first_panel = drawing.y;
    let bottom = first_panel + plot::height(panels.len());
    scale.draw_grid(&mut drawing, first_panel, bottom);
    legend.draw_flags(&mut drawing, &scale, top, bottom);
    plot::draw(&mut drawing, waves, panels, &scale);
    scale.draw_breaks(&mut drawing, first_panel, bottom);
    drawing.y = bottom;
    scale.draw_axis(&mut drawing);
    plot::names(&mut drawing, waves, panels);
    legend.draw_notes(&mut drawing, waves);
    drawing.y += 140;
    file(&drawing, head)
}

/// The drawing as a file.
fn file(drawing: &Drawing, head: &Head) -> String {
    let height = px(drawing.y + MARGIN - 60);
    let width = px(WIDTH);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" role=\"img\">\n<title>{}</title>\n{}<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>\n{}</svg>\n",
        escaped(&head.title),
        style::STYLE,
        drawing.text,
    )
}

fn title(drawing: &mut Drawing, head: &Head) {
    for line in wrapped(&head.title, 120) {
        drawing.y += 190;
        drawing.text("title", (MARGIN, drawing.y), &line);
    }
    let profile = head.profile.as_ref().map(|profile| format!(" \u{b7} profile {profile}")).unwrap_or_default();
    let case = head.case.as_ref().map(|case| format!(" \u{b7} {case}")).unwrap_or_default();
    let cycle = head.cycle_time.seconds() * 1e3;
    let machine = format!("machine {}{profile}{case} \u{b7} cycle {cycle} ms", head.machine);
    drawing.y += 190;
    drawing.text("small", (MARGIN, drawing.y), &machine);
    drawing.y += 160;
}

#[cfg(test)]
mod tests;
