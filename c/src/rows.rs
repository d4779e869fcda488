//! Rows of results while a simulation goes on: pushed to a callback, or pulled from another thread.

use crate::door::{Data, changed, door, places, quiet, usage};
use crate::error::CognateError;
use crate::session::{CognateSession, Inner, with};
use engine::Error;
use engine::diagnostic::counted;
use engine::results::{Column, Run};
use std::ffi::c_void;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// A callback that takes a row of results: the values of all columns in their order, time first.
/// Returns false to end the simulation; it is not called again in this one.
pub type CognateRow =
    Option<extern "C" fn(data: *mut c_void, values: *const f64, n: usize) -> bool>;

/// Rows of results that wait to be taken, by one thread at a time, while another simulates.
pub struct CognateRows(Receiver<Message>);

/// News from a simulation.
pub enum Message {
    /// a row
    Row(Vec<f64>),
    /// it has ended, however
    Ended,
}

/// The answer to the question for a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum CognateNext {
    /// there is one
    Row,
    /// there is none yet
    None,
    /// there is none, and the simulation has ended; rows of the next one may follow
    Ended,
}

/// Longest time for which a reader waits [s]
const LONGEST_WAIT: f64 = 1e9;

impl Inner {
    /// Hands each row that tables show to `take`, which returns whether it wants more.
    fn hand_rows(
        &mut self,
        keep: bool,
        mut take: impl FnMut(&[f64]) -> bool + Send + 'static,
    ) -> Result<(), Error> {
        if self.has_bars {
            let what = "rows come while a simulation goes on, and bars of error when it has ended";
            return Err(usage(what, "leave cognate_options_accuracy out"));
        }
        let enough = self.enough.clone();
        let (mut handed, mut values) = (self.session.run.rows(), Vec::new());
        self.session.receive(Box::new(move |run: &mut Run| {
            let new: Vec<usize> = run.table_places(handed..run.rows()).collect();
            for place in new {
                if enough.load(Ordering::Relaxed) {
                    break;
                }
                values.clear();
                let value = |column: &Column| column.values.get(place).copied();
                values.extend(run.columns.iter().map(|c| value(c).unwrap_or(f64::NAN)));
                if !take(&values) {
                    enough.store(true, Ordering::Relaxed);
                }
            }
            handed = run.rows();
            if !keep {
                run.release();
            }
        }));
        Ok(())
    }
}

/// Calls `callback` with `data` for each row of results while simulations go on, at most a second
/// after it was computed; before the first simulation, in place of what was set before.
///
/// `keep`: rows stay in the results of the session as well. Without it they are gone when the
/// callback has had them, and a run may be as long as it likes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_rows(
    session: *mut CognateSession,
    callback: CognateRow,
    data: *mut c_void,
    keep: bool,
    error: *mut *mut CognateError,
) -> bool {
    let data = Data(data);
    let set = |inner: &mut Inner| {
        let Some(callback) = callback else {
            return Err(usage("callback is NULL", "give a function that takes rows"));
        };
        inner.reader = None;
        inner.hand_rows(keep, move |values| {
            callback(data.pointer(), values.as_ptr(), values.len())
        })?;
        Ok(true)
    };
    // SAFETY: a handle and a place of the caller
    unsafe { with(session, error, false, set) }
}

/// Returns the rows of results that come while simulations of this session go on, for a thread that
/// takes them by cognate_rows_next; before the first simulation, in place of what was set before.
/// `keep`: as for cognate_session_rows. Rows wait until they are taken.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_queue(
    session: *mut CognateSession,
    keep: bool,
    error: *mut *mut CognateError,
) -> *mut CognateRows {
    let set = |inner: &mut Inner| {
        let (sender, rows) = channel();
        let reader = sender.clone();
        // a reader that has gone wants no more rows, and the simulation goes on
        inner.hand_rows(keep, move |values| {
            let _ = sender.send(Message::Row(values.to_vec()));
            true
        })?;
        inner.reader = Some(reader);
        Ok(Box::into_raw(Box::new(CognateRows(rows))))
    };
    // SAFETY: a handle and a place of the caller
    unsafe { with(session, error, std::ptr::null_mut(), set) }
}

/// Takes the next row: puts the values of all columns, which are cognate_session_columns, into
/// `values`, which has room for `n` numbers. Waits up to `seconds` for it.
///
/// COGNATE_NEXT_ENDED comes once behind the rows of each simulation, and for ever when the session
/// has been given back. A mistake (NULL, no room) is told by `error`, and COGNATE_NEXT_ENDED returned.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_rows_next(
    rows: *mut CognateRows,
    values: *mut f64,
    n: usize,
    seconds: f64,
    error: *mut *mut CognateError,
) -> CognateNext {
    let work = || {
        // SAFETY: a handle and places of the caller
        let (rows, values) = unsafe { (changed(rows, "rows")?, places(values, n, "values")?) };
        // NaN is no time to wait
        let seconds = match seconds.is_nan() {
            true => 0.0,
            false => seconds.clamp(0.0, LONGEST_WAIT),
        };
        let wait = Duration::from_secs_f64(seconds);
        match rows.0.recv_timeout(wait) {
            Ok(Message::Row(row)) => match values.get_mut(..row.len()) {
                Some(place) => {
                    place.copy_from_slice(&row);
                    Ok(CognateNext::Row)
                }
                None => {
                    let what = format!(
                        "a row has {}; there is room for {n}",
                        counted(row.len(), "number")
                    );
                    Err(usage(what, "cognate_session_columns tells how many"))
                }
            },
            Ok(Message::Ended) | Err(RecvTimeoutError::Disconnected) => Ok(CognateNext::Ended),
            Err(RecvTimeoutError::Timeout) => Ok(CognateNext::None),
        }
    };
    // SAFETY: a place of the caller
    unsafe { door(error, CognateNext::Ended, work) }
}

/// Gives rows back; simulations go on without a reader.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_rows_free(rows: *mut CognateRows) {
    if !rows.is_null() {
        // SAFETY: made by `cognate_session_queue`, given back once
        quiet((), || drop(unsafe { Box::from_raw(rows) }));
    }
}
