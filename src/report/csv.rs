//! All runs as CSV: a row a run, columns named as the keys of `results.json`.
//!
//! What lies deeper there is flat here: `place` becomes `place_mean_px`, the figures at 0.5 px `precision_0.5px` and so
//! on, a band's `near_precision`, a pass's `rasterize_ms` and `rasterize_bytes`, `floor` becomes `floor_copy_ms` and so on, a range `min_frame_range_ms` and `max_…`, hashes one
//! cell.
//! What a run has no value for is an empty cell.
//!
//! Does not handle: scenes and the machine, which stand in `results.json` only.

use std::io::{self, Write};

use serde_json::{Map, Value};

use super::{Results, merge};
use crate::measure::figures::{PlaceOffsets, Run};

/// Writes a line of names and a line for each run; nothing where there is none.
///
/// # Errors
/// Those of the writer.
pub fn write_csv(results: &Results, out: impl Write) -> io::Result<()> {
    let rows = results.runs.iter().map(row).collect::<io::Result<Vec<_>>>()?;
    // Methods have passes of their own: the columns are those of all rows.
    let names = merge(rows.iter().map(|row| row.iter().map(|(name, _)| name.as_str()).collect()));
    let mut writer = csv::Writer::from_writer(out);
    if !names.is_empty() {
        writer.write_record(&names)?;
    }
    for row in &rows {
        let cell = |name: &&str| row.iter().find(|(other, _)| other == *name).map_or("", |(_, cell)| cell);
        writer.write_record(names.iter().map(cell))?;
    }
    writer.flush()
}

/// The cells of a run with the names of their columns.
fn row(run: &Run) -> io::Result<Vec<(String, String)>> {
    // A method without places has the columns too: NaN becomes null, which is an empty cell.
    let place = run.place.clone().unwrap_or(PlaceOffsets { mean_px: f64::NAN, p95_px: f64::NAN });
    let run = Run { place: Some(place), ..run.clone() };
    let Value::Object(fields) = serde_json::to_value(run)? else {
        return Err(io::Error::other("a run is no object"));
    };
    let mut cells = Vec::new();
    fields.iter().for_each(|(key, value)| flatten(key, value, &mut cells));
    Ok(cells)
}

/// Adds the cells of a value: one, or those of what it holds.
fn flatten(key: &str, value: &Value, cells: &mut Vec<(String, String)>) {
    match value {
        Value::Null => cells.push((key.into(), String::new())),
        Value::String(text) => cells.push((key.into(), text.clone())),
        Value::Object(fields) => fields.iter().for_each(|(name, v)| flatten(&format!("{key}_{name}"), v, cells)),
        Value::Array(items) => match &items[..] {
            [Value::Object(_), ..] => items.iter().filter_map(Value::as_object).for_each(|item| labelled(item, cells)),
            [Value::Number(least), Value::Number(most)] => {
                cells.extend([("min", least), ("max", most)].map(|(end, v)| (format!("{end}_{key}"), v.to_string())));
            }
            _ => cells.push((key.into(), items.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(" "))),
        },
        Value::Bool(_) | Value::Number(_) => cells.push((key.into(), value.to_string())),
    }
}

/// Adds the cells of an element of a list, which has a `name` or a distance in `px` to tell it from the others.
fn labelled(item: &Map<String, Value>, cells: &mut Vec<(String, String)>) {
    for (field, value) in item {
        match (item.get("name").and_then(Value::as_str), item.get("px").and_then(Value::as_f64)) {
            (Some(name), _) if field != "name" => flatten(&format!("{name}_{field}"), value, cells),
            (None, Some(px)) if field != "px" => flatten(&format!("{field}_{px}px"), value, cells),
            _ => {}
        }
    }
}
