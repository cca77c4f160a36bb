//! JSON pointers (RFC 6901) to what may move.

use serde_json::{Number, Value};

use super::sampler::Values;

/// Lists of the root in which things may move.
const MUTABLE: [&str; 5] = ["nodes", "meshes", "materials", "cameras", "extensions"];

/// `values` as what stands at `pointer`.
///
/// # Errors
/// Where a number is not finite.
pub fn value(pointer: &str, values: Values) -> Result<Value, String> {
    let is_list = values.is_list || pointer.ends_with("/weights");
    let number = |&number: &f64| Number::from_f64(number).map(Value::Number);
    let numbers: Option<Vec<Value>> = values.numbers.iter().map(number).collect();
    let numbers = numbers.ok_or("its value is not finite")?;
    let visible = pointer.ends_with("/visible");
    match (numbers.into_iter().collect(), &values.numbers[..]) {
        (_, &[number]) if visible => Ok(Value::Bool(number != 0.0)),
        (Value::Array(mut list), _) if !is_list => Ok(list.remove(0)),
        (list, _) => Ok(list),
    }
}

/// Puts `value` where `pointer` leads; objects on the way, which may have been left out for their
/// defaults, are made.
///
/// # Errors
/// Where it leads nowhere, or to what must not move.
pub fn set(root: &mut Value, pointer: &str, value: Value) -> Result<(), String> {
    let mut names = pointer.split('/');
    let is_absolute = names.next() == Some("");
    let first = names.clone().next().unwrap_or("");
    if !is_absolute || !MUTABLE.contains(&first) {
        return Err(format!("{pointer:?} cannot be animated"));
    }
    let nowhere = || format!("{pointer:?} leads nowhere");
    let mut place = root;
    for name in names {
        let name = name.replace("~1", "/").replace("~0", "~");
        place = match place {
            Value::Array(list) => {
                let index = name.parse().ok();
                let entry = index.and_then(|index: usize| list.get_mut(index));
                entry.ok_or_else(nowhere)?
            }
            Value::Object(map) => map.entry(name).or_insert(Value::Null),
            // Made on the way.
            Value::Null => {
                *place = Value::Object(serde_json::Map::new());
                &mut place[name]
            }
            _ => return Err(nowhere()),
        };
    }
    *place = value;
    Ok(())
}
