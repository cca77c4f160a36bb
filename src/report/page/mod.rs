//! Self-contained HTML pages about pictures.
//!
//! A page needs no network: pictures are in it, and so are its style and script. It works with the
//! keyboard alone, and in print or without scripts, where what moves stands side by side. The parts
//! ([`slider`], [`error_figure`], [`table`]) are text to be put into a [`document`].

mod bar;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::Picture;
use super::error_map::colored;
use super::metrics::ErrorValues;
use super::scale::Scale;
use crate::output::png::{self, PngOptions};

pub use bar::color_bar;

/// A picture of a page.
#[derive(Clone, Debug)]
pub struct Shown {
    /// Its name, not escaped.
    pub label: String,
    /// Where its pixels are: a `data:` address.
    pub source: String,
    /// Its columns.
    pub width: u32,
}

impl Shown {
    /// `picture` as a screen shows it: clipped to `[0, 1]`, sRGB, 8 bits.
    ///
    /// # Errors
    /// Where the picture has no pixels.
    pub fn new(label: &str, picture: &Picture) -> std::io::Result<Self> {
        let mut bytes = Vec::new();
        let options = PngOptions::default();
        png::encode(&mut bytes, picture.size, &picture.pixels, None, options)?;
        Ok(Self {
            label: label.to_owned(),
            source: format!("data:image/png;base64,{}", STANDARD.encode(bytes)),
            width: picture.size.x,
        })
    }

    fn image(&self) -> String {
        format!(
            "<img src=\"{}\" alt=\"{}\">",
            self.source,
            escaped(&self.label)
        )
    }

    /// Small pictures are enlarged by a whole number, so that their pixels can be told apart.
    fn shown_width(&self) -> u32 {
        const WANTED: u32 = 640;
        self.width * (WANTED / self.width.max(1)).max(1)
    }
}

/// A whole page: `body` is HTML, `title` is not escaped yet.
pub fn document(title: &str, body: &str) -> String {
    document_with(title, body, "", "")
}

/// As [`document`], with more style and a script of its own after those that every page has.
pub fn document_with(title: &str, body: &str, more_style: &str, more_script: &str) -> String {
    let title = escaped(title);
    let style = include_str!("page.css");
    let script = include_str!("page.js");
    let more_script = match more_script {
        "" => String::new(),
        script => format!("<script>\n{script}</script>\n"),
    };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{style}{more_style}</style>\n</head>\n<body>\n<main>\n\
         <h1>{title}</h1>\n{body}</main>\n<script>\n{script}</script>\n{more_script}</body>\n</html>\n"
    )
}

/// Two pictures of one size, one over the other, with a border that can be moved.
pub fn slider(left: &Shown, right: &Shown) -> String {
    let figure = |side: &str, shown: &Shown| {
        format!(
            "<figure class=\"{side}\">{}<figcaption>{}</figcaption></figure>\n",
            shown.image(),
            escaped(&shown.label)
        )
    };
    format!(
        "<div class=\"slider\" style=\"--width:{}px\">\n<div class=\"pictures\">\n{}{}</div>\n\
         <label>Border between the pictures (arrow keys; Home and End show one alone)\n\
         <input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"1\"></label>\n</div>\n",
        left.shown_width(),
        figure("left", left),
        figure("right", right)
    )
}

/// An error map with its colour bar under a title, which is not escaped yet.
///
/// # Errors
/// Where there are no pixels.
pub fn error_figure(title: &str, errors: &ErrorValues, scale: Scale) -> std::io::Result<String> {
    Ok(map_figure(
        &Shown::new(title, &colored(errors, scale))?,
        scale,
    ))
}

/// As [`error_figure`], of errors that are colours already.
pub fn map_figure(map: &Shown, scale: Scale) -> String {
    format!(
        "<figure class=\"map\" style=\"--width:{}px\">\n<figcaption>{}</figcaption>\n{}\n{}\
         </figure>\n",
        map.shown_width(),
        escaped(&map.label),
        map.image(),
        color_bar(scale)
    )
}

/// A table of text, not escaped yet, whose first column names the rows.
pub fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let cells = |tag: &str, cells: &mut dyn Iterator<Item = &str>| -> String {
        cells
            .map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell)))
            .collect()
    };
    let row = |row: &Vec<String>| {
        let (name, others) = match row.split_first() {
            Some((name, others)) => (escaped(name), others),
            None => (String::new(), &[][..]),
        };
        let others = cells("td", &mut others.iter().map(String::as_str));
        format!("<tr><th scope=\"row\">{name}</th>{others}</tr>\n")
    };
    format!(
        "<table>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n</table>\n",
        cells("th", &mut head.iter().copied()),
        rows.iter().map(row).collect::<String>()
    )
}

/// The text as HTML, also between quotation marks.
pub fn escaped(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => html.push_str("&amp;"),
            '<' => html.push_str("&lt;"),
            '>' => html.push_str("&gt;"),
            '"' => html.push_str("&quot;"),
            c => html.push(c),
        }
    }
    html
}
