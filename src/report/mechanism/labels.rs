//! Places of names on a picture: each at its point if there is room, else beside it, else nowhere.
//! A name that would run off the picture is moved in.
//!
//! Names are placed one after the other, in their order. Places are tried from the point outwards;
//! one is free if no name that was placed before overlaps it and it lies on the picture. In px.

/// Width of a letter, as a part of the size of letters.
const LETTER_WIDTH: f64 = 0.58;
/// Height of a name, as a part of the size of letters.
const HEIGHT: f64 = 1.15;
/// Distances from the point that are tried, in heights of a name.
const DISTANCES: [f64; 5] = [1.0, 1.6, 2.4, 3.4, 4.6];
/// Directions that are tried: beside, above and below first.
const DIRECTIONS: [[f64; 2]; 8] = [
    [0.0, -1.0],
    [0.0, 1.0],
    [1.0, 0.0],
    [-1.0, 0.0],
    [0.7, -0.7],
    [-0.7, -0.7],
    [0.7, 0.7],
    [-0.7, 0.7],
];

/// Part of the width of a picture that a name takes at most.
const WIDEST: f64 = 0.4;

/// Returns a name as it is written on a picture of some width: the middle of a long one is left
/// out.
pub(super) fn written(name: &str, width: f64, letters: f64) -> String {
    crate::report::cut(name, (WIDEST * width / (LETTER_WIDTH * letters)) as usize)
}

/// A rectangle: its middle and half its width and height.
#[derive(Clone, Copy)]
pub(super) struct Area {
    /// its middle
    pub middle: [f64; 2],
    /// half its width and height
    pub half: [f64; 2],
}

impl Area {
    fn overlaps(&self, other: &Area) -> bool {
        (0..2).all(|k| (self.middle[k] - other.middle[k]).abs() < self.half[k] + other.half[k])
    }

    /// Returns it moved onto a picture, as far as it has room there.
    fn moved_onto(mut self, size: [f64; 2]) -> Self {
        for (k, whole) in size.into_iter().enumerate() {
            let most = whole - self.half[k];
            self.middle[k] = self.middle[k].min(most).max(self.half[k]);
        }
        self
    }

    fn lies_on(&self, size: [f64; 2]) -> bool {
        (0..2).all(|k| self.middle[k] >= self.half[k] && self.middle[k] + self.half[k] <= size[k])
    }
}

/// The place of a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Placed {
    /// at its point
    There,
    /// over it, with its middle here, where it lies on the picture
    Moved([f64; 2]),
    /// beside it, with its middle here; a line leads to the point
    Beside([f64; 2]),
    /// there is no room
    LeftOut,
}

/// Returns where names go, in their order.
///
/// `names` are points and texts, `size` that of the picture, `letters` the size of letters,
/// `reserved` areas where no name goes.
pub(super) fn placed(
    names: &[([f64; 2], String)],
    size: [f64; 2],
    letters: f64,
    reserved: &[Area],
) -> Vec<Placed> {
    let mut taken = reserved.to_vec();
    let mut all = Vec::new();
    for (point, text) in names {
        let height = HEIGHT * letters;
        let width = LETTER_WIDTH * letters * text.chars().count() as f64;
        let half = [width / 2.0, height / 2.0];
        let at = |middle: [f64; 2]| Area { middle, half };
        let is_free = |area: &Area| !taken.iter().any(|other| area.overlaps(other));
        let there = at(*point).moved_onto(size);
        let found = match is_free(&there) {
            true if there.middle == *point => Some((there, Placed::There)),
            true => Some((there, Placed::Moved(there.middle))),
            false => candidates(*point, half, height)
                .map(at)
                .find(|area| area.lies_on(size) && is_free(area))
                .map(|area| (area, Placed::Beside(area.middle))),
        };
        all.push(found.map_or(Placed::LeftOut, |(_, placed)| placed));
        taken.extend(found.map(|(area, _)| area));
    }
    all
}

/// Returns the middles that are tried, from the nearest outwards.
fn candidates(point: [f64; 2], half: [f64; 2], height: f64) -> impl Iterator<Item = [f64; 2]> {
    DISTANCES.into_iter().flat_map(move |distance| {
        DIRECTIONS.into_iter().map(move |[right, down]| {
            // sideways a name begins beside the point
            let beside = right * (distance * height + half[0]);
            [point[0] + beside, point[1] + down * distance * height]
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(point: [f64; 2], text: &str, placed: Placed, letters: f64) -> Option<Area> {
        let middle = match placed {
            Placed::There => point,
            Placed::Moved(middle) | Placed::Beside(middle) => middle,
            Placed::LeftOut => return None,
        };
        let width = LETTER_WIDTH * letters * text.chars().count() as f64;
        let half = [width / 2.0, HEIGHT * letters / 2.0];
        Some(Area { middle, half })
    }

    #[test]
    fn no_two_names_overlap_and_those_alone_stay_at_their_points() {
        let texts: Vec<String> = (0..60).map(|k| format!("JOINT/{k}")).collect();
        for spread in [0.0, 3.0, 20.0, 400.0] {
            let points: Vec<[f64; 2]> = (0..60)
                .map(|k| f64::from(k) * 2.4)
                .map(|a| {
                    [
                        300.0 + spread * a.cos(),
                        250.0 + spread * (1.7 * a).sin() / 2.0,
                    ]
                })
                .collect();
            let names: Vec<([f64; 2], String)> =
                points.iter().copied().zip(texts.clone()).collect();
            let all = placed(&names, [600.0, 500.0], 13.0, &[]);
            let areas: Vec<Area> = (names.iter().zip(&all))
                .filter_map(|((point, text), placed)| area(*point, text, *placed, 13.0))
                .collect();
            for (k, a) in areas.iter().enumerate() {
                assert!(areas[..k].iter().all(|b| !a.overlaps(b)), "{spread}");
            }
            assert!(areas.len() > 12, "{spread}: {}", areas.len());
        }
        let far = [100.0, 300.0].map(|x| ([x, 100.0], "PART/2".to_owned()));
        assert_eq!(placed(&far, [600.0, 500.0], 13.0, &[]), [Placed::There; 2]);
        // what is reserved stays free
        let bar = Area {
            middle: [100.0, 100.0],
            half: [60.0, 14.0],
        };
        let beside = placed(&far, [600.0, 500.0], 13.0, &[bar]);
        assert!(matches!(beside[0], Placed::Beside(_)) && beside[1] == Placed::There);
    }

    #[test]
    fn no_name_runs_off_the_picture_however_long_it_is() {
        let size = [600.0, 500.0];
        for length in [3, 20, 40, 200, 4000] {
            let name = written(&"x".repeat(length), size[0], 13.0);
            for point in [[0.0, 0.0], [5.0, 250.0], [599.0, 250.0], [300.0, 499.0]] {
                let placed = placed(&[(point, name.clone())], size, 13.0, &[]);
                let area = area(point, &name, placed[0], 13.0).expect("alone it has room");
                assert!(area.lies_on(size), "{length} at {point:?}");
            }
        }
    }
}
