//! "Did you mean …?"

/// The end of a message about `word`, which is none of `known`: the nearest of them, or all.
pub fn suggestion(word: &str, known: &[&str]) -> String {
    let distance =
        |other: &str| strsim::damerau_levenshtein(&word.to_lowercase(), &other.to_lowercase());
    let nearest = known
        .iter()
        .map(|other| (distance(other), *other))
        .min_by_key(|(distance, _)| *distance);
    match nearest {
        None => "there are none".to_owned(),
        // A third of the letters may be wrong; beyond that it is another word.
        Some((distance, other)) if distance <= word.chars().count().div_ceil(3).max(2) => {
            format!("did you mean \"{other}\"?")
        }
        Some(_) => format!("known: {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::suggestion;

    #[test]
    fn a_slip_is_named_and_another_word_is_not_guessed_at() {
        let known = ["radius", "radiance", "position"];
        assert_eq!(suggestion("raduis", &known), "did you mean \"radius\"?");
        assert_eq!(suggestion("Radiance", &known), "did you mean \"radiance\"?");
        assert_eq!(
            suggestion("brightness", &known),
            "known: radius, radiance, position"
        );
        assert_eq!(suggestion("x", &[]), "there are none");
    }
}
