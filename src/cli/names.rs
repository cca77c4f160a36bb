//! Options that take one of several names.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use halfshade::bvh::Builder;

/// Reads one of `choices` by its name, and lists the names in help and errors.
pub fn one_of<T: Copy + Send + Sync + 'static>(
    choices: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(choices.iter().map(move |&choice| name(choice))).try_map(
        move |given| {
            let mut choices = choices.iter().copied();
            choices
                .find(|&choice| name(choice) == given)
                .ok_or("not one of them")
        },
    )
}

/// Reads the name of a builder, and lists the names in help and errors.
pub fn builder() -> impl TypedValueParser<Value = Builder> {
    PossibleValuesParser::new(Builder::ALL.map(Builder::name)).try_map(|given| given.parse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::layers::LayerKind;
    use halfshade::sampling::{Pattern, Target};
    use halfshade::scene::{IntegratorKind, ToneMap};

    /// A name that two choices share would hide the second.
    fn assert_read_back<T: Copy + Send + Sync + PartialEq + std::fmt::Debug>(
        choices: &'static [T],
        name: fn(T) -> &'static str,
    ) {
        let command = clap::Command::new("test");
        let parser = one_of(choices, name);
        for &choice in choices {
            let read = parser.parse_ref(&command, None, name(choice).as_ref());
            assert_eq!(read.ok(), Some(choice));
        }
    }

    #[test]
    fn every_choice_is_read_by_its_name() {
        assert_read_back(Pattern::ALL, Pattern::name);
        assert_read_back(Target::ALL, Target::name);
        assert_read_back(IntegratorKind::ALL, IntegratorKind::name);
        assert_read_back(ToneMap::ALL, ToneMap::name);
        assert_read_back(LayerKind::ALL, LayerKind::name);
    }
}
