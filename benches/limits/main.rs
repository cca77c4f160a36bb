//! `cargo bench --bench limits -- WHAT [SCENE…]`: is what a render says about its own error true?
//!
//! * `calibration`: over 200 seeds, how often the 95 % interval holds the true error, and what is stated over what is true;
//! * `asked`: `--error` and `--time`, asked against stated, true and forecast;
//! * `adaptive`: error of adaptive against uniform sampling at equal processor time.
//!
//! True errors are those against a render with many more samples, whose own estimated
//! error is subtracted.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod adaptive;
mod asked;
mod calibration;
mod subject;

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    let (what, scenes) = match arguments.split_first() {
        Some((what, scenes)) => (what.as_str(), scenes),
        None => ("", &[][..]),
    };
    match what {
        "calibration" => calibration::run(scenes),
        "asked" => asked::run(scenes),
        "adaptive" => adaptive::run(scenes),
        _ => println!("which of calibration, asked, adaptive?"),
    }
}
