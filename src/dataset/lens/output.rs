//! Requests and graphics: markers, functions and shapes.

use super::*;

/// The markers I, J, RM of a request for a quantity.
fn request_slots(kind: &mut RequestKind) -> Option<(&mut u32, &mut Option<u32>, &mut Option<u32>)> {
    match kind {
        RequestKind::Displacement { i, j, rm }
        | RequestKind::Velocity { i, j, rm }
        | RequestKind::Acceleration { i, j, rm }
        | RequestKind::Force { i, j, rm } => Some((i, j, rm)),
        RequestKind::Functions(_) | RequestKind::User(_) => None,
    }
}

/// DISPLACEMENT, VELOCITY, ACCELERATION, FORCE; the markers stay.
pub fn ask(request: &mut Request, quantity: Quantity) -> Done {
    let (i, j, rm) = match request_slots(&mut request.kind) {
        Some((i, j, rm)) => (*i, *j, *rm),
        None => (0, None, None),
    };
    request.kind = match quantity {
        Quantity::Displacement => RequestKind::Displacement { i, j, rm },
        Quantity::Velocity => RequestKind::Velocity { i, j, rm },
        Quantity::Acceleration => RequestKind::Acceleration { i, j, rm },
        Quantity::Force => RequestKind::Force { i, j, rm },
    };
    Ok(())
}

/// See [`ask`].
pub fn asked(request: &Request, quantity: Quantity) -> Option<Value> {
    let is = match request.kind {
        RequestKind::Displacement { .. } => quantity == Quantity::Displacement,
        RequestKind::Velocity { .. } => quantity == Quantity::Velocity,
        RequestKind::Acceleration { .. } => quantity == Quantity::Acceleration,
        RequestKind::Force { .. } => quantity == Quantity::Force,
        RequestKind::Functions(_) | RequestKind::User(_) => false,
    };
    is.then_some(Value::Flag)
}

/// I, J, RM.
pub fn put_request_marker(request: &mut Request, which: usize, value: Value) -> Done {
    let Some((i, j, rm)) = request_slots(&mut request.kind) else {
        return Err("I, J and RM go with DISPLACEMENT, VELOCITY, ACCELERATION or FORCE".into());
    };
    id(value, |n| match which {
        0 => *i = n,
        1 => *j = Some(n),
        _ => *rm = Some(n),
    })
}

/// See [`put_request_marker`].
pub fn request_marker(request: &Request, which: usize) -> Option<Value> {
    let mut kind = request.kind.clone();
    let (i, j, rm) = request_slots(&mut kind)?;
    match which {
        0 => i.written(),
        1 => j.written(),
        _ => rm.written(),
    }
}

/// F1 … F8.
pub fn put_request_function(request: &mut Request, k: usize, value: Value) -> Done {
    match &mut request.kind {
        RequestKind::Functions(f) => f[k].put(value),
        _ => Err(
            "F1 to F8 do not go with DISPLACEMENT, VELOCITY, ACCELERATION, FORCE or FUNCTION"
                .into(),
        ),
    }
}

/// See [`put_request_function`].
pub fn request_function(request: &Request, k: usize) -> Option<Value> {
    match &request.kind {
        RequestKind::Functions(f) => f[k].written(),
        _ => None,
    }
}

/// FUNCTION=USER(…), ROUTINE.
pub fn request_user(request: &mut Request) -> &mut Formula {
    if !matches!(request.kind, RequestKind::User(_)) {
        request.kind = RequestKind::User(Formula::default());
    }
    match &mut request.kind {
        RequestKind::User(f) => f,
        _ => unreachable!("made so above"),
    }
}

/// CM: one marker, or for an OUTLINE several.
pub fn put_graphics_cm(graphics: &mut Graphics, value: Value) -> Done {
    let text = value.to_string();
    let Value::Ids(ids) = value else {
        return Err(MISFIT.into());
    };
    match (&mut graphics.shape, ids.as_slice()) {
        (
            Shape::Cylinder { cm, .. }
            | Shape::Frustum { cm, .. }
            | Shape::Ellipsoid { cm, .. }
            | Shape::Torus { cm, .. }
            | Shape::Circle { cm, .. }
            | Shape::Arc { cm, .. },
            [one],
        ) => *cm = *one,
        (Shape::Other(_), _) => graphics.keep("CM", text),
        _ => return Err("this shape does not take these markers".into()),
    }
    Ok(())
}

/// See [`put_graphics_cm`].
pub fn graphics_cm(graphics: &Graphics) -> Option<Value> {
    match &graphics.shape {
        Shape::Cylinder { cm, .. }
        | Shape::Frustum { cm, .. }
        | Shape::Ellipsoid { cm, .. }
        | Shape::Torus { cm, .. }
        | Shape::Circle { cm, .. }
        | Shape::Arc { cm, .. } => Some(Value::Ids(vec![*cm])),
        _ => None,
    }
}

/// RANGLE: how far an ARC goes from the x axis of its marker; of other shapes it is only kept.
pub fn put_arc_angle(graphics: &mut Graphics, value: Value) -> Done {
    if let Shape::Arc { angle, .. } = &mut graphics.shape {
        *angle = real(value)?;
    } else {
        graphics.keep("RANGLE", value.to_string());
    }
    Ok(())
}

/// See [`put_arc_angle`].
pub fn arc_angle(graphics: &Graphics) -> Option<Value> {
    match &graphics.shape {
        Shape::Arc { angle, .. } => angle.written(),
        _ => None,
    }
}

/// XMIN, XMAX, YMIN, YMAX of a PLANE.
pub fn put_bound(graphics: &mut Graphics, along_y: bool, upper: usize, value: Value) -> Done {
    let Shape::Plane { x, y, .. } = &mut graphics.shape else {
        return Err("this goes with PLANE".into());
    };
    let bounds = if along_y { y } else { x };
    bounds[upper] = Some(real(value)?);
    Ok(())
}

/// See [`put_bound`].
pub fn bound(graphics: &Graphics, along_y: bool, upper: usize) -> Option<Value> {
    match &graphics.shape {
        Shape::Plane { y, .. } if along_y => y[upper].written(),
        Shape::Plane { x, .. } => x[upper].written(),
        _ => None,
    }
}
