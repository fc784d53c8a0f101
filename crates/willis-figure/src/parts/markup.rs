//! A figure's markup, changed where it stands.

use crate::parts::style::number;

/// Gives attributes another value, where `new` has one for a name and value. What is not an
/// attribute stays byte for byte.
pub(crate) fn rewrite(svg: &str, mut new: impl FnMut(&str, &str) -> Option<String>) -> String {
    let mut out = String::with_capacity(svg.len());
    let mut rest = svg;
    while let Some(at) = rest.find('<') {
        out.push_str(&rest[..at]);
        rest = &rest[at..];
        let closed = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>"), ("<!", ">"), ("</", ">")]
            .into_iter()
            .find(|(open, _)| rest.starts_with(open));
        if let Some((_, close)) = closed {
            let end = rest.find(close).map_or(rest.len(), |end| end + close.len());
            out.push_str(&rest[..end]);
            rest = &rest[end..];
        } else {
            rest = tag(rest, &mut out, &mut new);
        }
    }
    out + rest
}

/// Copies a tag; what follows it.
fn tag<'s>(mut rest: &'s str, out: &mut String, new: &mut impl FnMut(&str, &str) -> Option<String>) -> &'s str {
    loop {
        let Some(at) = rest.find(['"', '\'', '>']) else {
            out.push_str(rest);
            return "";
        };
        let quote = &rest[at..=at];
        out.push_str(&rest[..=at]);
        if quote == ">" {
            return &rest[at + 1..];
        }
        let name = rest[..at].trim_end().trim_end_matches('=').trim_end();
        let name = name.rsplit(char::is_whitespace).next().unwrap_or(name);
        rest = &rest[at + 1..];
        let end = rest.find(quote).unwrap_or(rest.len());
        let value = &rest[..end];
        match new(name, value) {
            Some(other) => out.push_str(&other),
            None => out.push_str(value),
        }
        rest = &rest[end..];
        if let Some(behind) = rest.strip_prefix(quote) {
            out.push_str(quote);
            rest = behind;
        }
    }
}

/// The value of an attribute of the tag with which a text begins.
pub(crate) fn attribute(text: &str, wanted: &str) -> Option<String> {
    let mut found = None;
    let end = text.find('>').map_or(text.len(), |end| end + 1);
    rewrite(&text[..end], |name, value| {
        if name == wanted && found.is_none() {
            found = Some(value.to_owned());
        }
        None
    });
    found
}

/// Whether an attribute is a colour written `#rrggbb`.
pub(crate) fn is_colour(name: &str, value: &str) -> bool {
    matches!(name, "fill" | "stroke" | "stop-color" | "flood-color" | "color")
        && value.len() == 7
        && value.starts_with('#')
        && value[1..].bytes().all(|b| b.is_ascii_hexdigit())
}

/// Puts a prefix before all ids of a figure and before what refers to them, so that several figures
/// stand on one page.
pub(crate) fn prefixed(svg: &str, prefix: &str) -> String {
    rewrite(svg, |name, value| match name {
        "id" => Some(format!("{prefix}{value}")),
        "href" | "xlink:href" => value.strip_prefix('#').map(|id| format!("#{prefix}{id}")),
        "aria-labelledby" | "aria-describedby" => {
            let ids: Vec<String> = value.split_whitespace().map(|id| format!("{prefix}{id}")).collect();
            Some(ids.join(" "))
        }
        _ if value.contains("url(#") => Some(value.replace("url(#", &format!("url(#{prefix}"))),
        _ => None,
    })
}

/// A figure without its heading, which stands above all else on its page: its caption says the same.
pub(crate) fn untitled(svg: &str) -> String {
    /// What the heading takes.
    const HEADING: f64 = 42.0;
    let shorter = || {
        let at = svg.match_indices("<text").map(|(at, _)| at).find(|at| {
            let is = |name: &str, value: &str| attribute(&svg[*at..], name).as_deref() == Some(value);
            is("font-size", "20") && is("y", "38")
        })?;
        let end = at + svg[at..].find("</text>")? + "</text>".len();
        let (open, close) = (svg.find("<svg")?, svg.find('>')?);
        let head = svg.get(open..=close)?;
        let (height, width) = (attribute(head, "height")?, attribute(head, "width")?);
        let rest = number(height.parse::<f64>().ok()? - HEADING);
        let new = rewrite(head, |name, _| match name {
            "height" => Some(rest.clone()),
            "viewBox" => Some(format!("0 {HEADING} {width} {rest}")),
            _ => None,
        });
        Some([&svg[..open], &new, &svg[close + 1..at], &svg[end..]].concat())
    };
    shorter().unwrap_or_else(|| svg.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_and_what_refers_to_them_get_a_prefix() {
        let svg = r##"<?xml version="1.0"?><svg aria-labelledby="a b"><clipPath id="a"/><g clip-path="url(#a)" x = "1"><use href="#a"/> id="a" &lt;</g></svg>"##;
        let expected = r##"<?xml version="1.0"?><svg aria-labelledby="f-a f-b"><clipPath id="f-a"/><g clip-path="url(#f-a)" x = "1"><use href="#f-a"/> id="a" &lt;</g></svg>"##;
        assert_eq!(prefixed(svg, "f-"), expected);
    }

    #[test]
    fn the_heading_goes_and_the_page_is_shorter() {
        let words = r#"<text font-size="11" y="38">a</text><text fill="b" font-size="20" y="38">\nTitle\n</text>"#;
        let svg = format!(r#"<svg height="100" viewBox="0 0 50 100" width="50"><desc>d</desc>{words}</svg>"#);
        let expected = r#"<svg height="58" viewBox="0 42 50 58" width="50"><desc>d</desc><text font-size="11" y="38">a</text></svg>"#;
        assert_eq!(untitled(&svg), expected);
        assert_eq!(untitled(expected), expected);
    }

    #[test]
    fn broken_markup_is_copied() {
        for broken in
            ["<", "<a", "<a b", "<a b=", "<a b='", "<a b='c", "<!--", "<![CDATA[<a b='c'>", "a > b", "<é b='ü'"]
        {
            assert_eq!(rewrite(broken, |_, _| None), broken);
            assert_eq!(untitled(broken), broken);
        }
    }
}
