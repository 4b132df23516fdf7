//! The page: style, data and script in one file, nothing loaded from anywhere.

use super::input::{ReportFigure, ReportInput};
use super::viewer;

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("viewer.js");

/// The whole page.
pub(crate) fn html(input: &ReportInput) -> String {
    let facts = rows(&input.facts);
    let story = rows(&input.story);
    let figures: String = input.figures.iter().map(figure).collect();
    // The data come last, so that nothing in them is taken for a place holder.
    PAGE.replace("{{title}}", &escape(&input.title))
        .replace("{{lead}}", &escape(&input.lead))
        .replace("{{command}}", &escape(&input.command))
        .replace("{{style}}", STYLE)
        .replace("{{script}}", SCRIPT)
        .replace("{{facts}}", &facts)
        .replace("{{story}}", &story)
        .replace("{{figures}}", &figures)
        .replace(
            "{{scene}}",
            &viewer::json(&input.scene).replace('<', "\\u003c"),
        )
}

fn rows(rows: &[(String, String)]) -> String {
    let row = |(name, value): &(String, String)| {
        format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n",
            escape(name),
            escape(value)
        )
    };
    rows.iter().map(row).collect()
}

fn figure(figure: &ReportFigure) -> String {
    let svg = responsive(&figure.svg);
    let (name, caption) = (escape(&figure.name), escape(&figure.caption));
    format!("<figure>{svg}<figcaption><b>{name}</b> {caption}</figcaption></figure>\n")
}

/// Lets the picture follow the page's width.
fn responsive(svg: &str) -> String {
    let start = svg.find("<svg").unwrap_or_default();
    svg.get(start..)
        .unwrap_or_default()
        .replacen("<svg", "<svg class=\"plot\"", 1)
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::input::ViewerScene;

    #[test]
    fn the_page_is_whole_and_loads_nothing() {
        let input = ReportInput {
            title: "a <b> & c".to_owned(),
            facts: vec![("coverage".to_owned(), "100 %".to_owned())],
            figures: vec![ReportFigure {
                svg: "<svg></svg>".to_owned(),
                ..Default::default()
            }],
            scene: ViewerScene {
                up: [0.0, 0.0, 1.0],
                ..Default::default()
            },
            ..Default::default()
        };
        let page = html(&input);
        assert!(!page.contains("{{"), "a place holder is left");
        assert!(page.contains("a &lt;b&gt; &amp; c") && page.contains("<svg class=\"plot\">"));
        for foreign in ["src=", "href=\"http", "@import", "url("] {
            assert!(!page.contains(foreign), "{foreign} loads something");
        }
    }
}
