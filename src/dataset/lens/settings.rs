//! Settings and units: arguments by their keywords.

use super::*;

/// Puts a value under its keyword: numbers among the numbers, everything else as text among the
/// words.
pub fn put_setting(settings: &mut Settings, name: &str, value: Value) -> Done {
    let key = canonical(name);
    match value {
        Value::Real(x) => {
            settings.numbers.insert(key, x.value());
        }
        Value::Flag => {
            settings.words.insert(key, String::new());
        }
        other => {
            settings.words.insert(key, other.to_string());
        }
    }
    Ok(())
}

/// The value under a keyword.
pub fn setting(settings: &Settings, name: &str, kind: Kind) -> Option<Value> {
    let key = canonical(name);
    if let Some(&x) = settings.numbers.get(&key) {
        let angle = kind == Kind::Real { angle: true };
        return Some(Value::Real(if angle {
            Number::angle(x)
        } else {
            Number::plain(x)
        }));
    }
    settings.words.get(&key).map(|word| match kind {
        Kind::Flag => Value::Flag,
        _ => Value::Raw(word.clone()),
    })
}

/// Sets one of the four units.
pub fn put_unit(
    units: &mut Option<Units>,
    value: Value,
    of: fn(&mut Units) -> &mut String,
) -> Done {
    let Value::Word(word) = value else {
        return Err(MISFIT.into());
    };
    *of(units.get_or_insert_with(|| Units::new("", "", "", ""))) = word;
    Ok(())
}

/// One of the four units.
pub fn unit(units: &Option<Units>, of: fn(&Units) -> &String) -> Option<Value> {
    let word = of(units.as_ref()?);
    (!word.is_empty()).then(|| Value::Word(word.clone()))
}

/// Sets all units by the name of a system.
pub fn put_unit_system(units: &mut Option<Units>, value: Value) -> Done {
    let Value::Word(word) = value else {
        return Err(MISFIT.into());
    };
    let [f, m, l, t] = units::system(&word).unwrap_or([""; 4]);
    *units = Some(Units::new(f, m, l, t));
    Ok(())
}

/// SYSTEM=NONE where nothing else is said.
pub fn no_units(units: &Option<Units>) -> Option<Value> {
    let u = units.as_ref()?;
    let named = [&u.force, &u.mass, &u.length, &u.time];
    let nothing = named.iter().all(|w| w.is_empty()) && stated_ucf(units).is_none();
    nothing.then(|| Value::Word("NONE".to_owned()))
}

/// Sets the factor itself; without named units.
pub fn put_ucf(units: &mut Option<Units>, value: Value) -> Done {
    let ucf = real(value)?;
    if ucf.is_nan() || ucf <= 0.0 {
        return Err("UCF must be positive".into());
    }
    units.get_or_insert_with(|| Units::new("", "", "", "")).ucf = ucf;
    Ok(())
}

/// The factor where the units do not say it themselves.
pub fn stated_ucf(units: &Option<Units>) -> Option<Value> {
    let u = units.as_ref()?;
    let said = units::consistency(&u.force, &u.mass, &u.length, &u.time);
    (u.ucf != said).then(|| Value::Real(Number::plain(u.ucf)))
}

/// All four units or none; the factor follows from them.
pub fn consistent_units(units: &mut Option<Units>) -> Done {
    let Some(u) = units else {
        return Ok(());
    };
    let four = [
        ("FORCE", &u.force),
        ("MASS", &u.mass),
        ("LENGTH", &u.length),
        ("TIME", &u.time),
    ];
    let missing: Vec<&str> = four
        .iter()
        .filter(|(_, w)| w.is_empty())
        .map(|(k, _)| *k)
        .collect();
    match missing.len() {
        0 => {
            u.ucf = units::consistency(&u.force, &u.mass, &u.length, &u.time);
            Ok(())
        }
        4 => Ok(()),
        _ => Err(format!(
            "UNITS needs FORCE, MASS, LENGTH and TIME together; {} not given",
            missing.join(", ")
        )),
    }
}
