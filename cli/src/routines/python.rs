//! Routines in Python: a child process that runs `server.py`, which loads the file of the user.
//!
//! It is started where `--routines` names a file .py, and for nothing else. Both sides write frames
//! into pipes: the length of the rest in four bytes, a letter, and what belongs to it. Numbers are
//! as they lie in memory, lower bytes first, so that no digit is lost.
//!
//! ```text
//! F name                            is there such a function?                     Y, N
//! D name members                    an element, as JSON                           Y number
//! C element name PAR args           a call; until R or E Python may ask:          R numbers, E text
//!     A name numbers                a function of the model                       v number, n
//!     S name numbers                several at once                               v numbers, n
//!     M ends text                   a message                                     v
//! ```

use super::forms::{Ask, Asker, Flag, Moment};
use cognate::diagnostic::counted;
use cognate::internals::system::asked;
use std::io::{BufReader, BufWriter, ErrorKind, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};

/// Names the Python that is run; without it, `python3`.
pub const PYTHON: &str = "COGNATE_PYTHON";
/// The program that the child runs.
const SERVER: &str = include_str!("server.py");
/// Longest frame that is read from a child   [bytes]
const LONGEST: usize = 1 << 24;

/// A file of routines that a Python has loaded.
pub struct Loaded(Mutex<Pipes>);

/// A routine of it.
#[derive(Clone)]
pub struct Routine {
    name: String,
    of: Arc<Loaded>,
    /// number of the element in the child, once it has been told
    element: Arc<Mutex<Option<u32>>>,
}

struct Pipes {
    child: Child,
    /// taken when it ends
    to: Option<BufWriter<ChildStdin>>,
    from: BufReader<ChildStdout>,
}

impl Drop for Pipes {
    fn drop(&mut self) {
        // the child ends where its input does
        self.to = None;
        let _ = self.child.wait();
    }
}

/// Returns the Python that is run.
fn program() -> String {
    std::env::var(PYTHON).unwrap_or_else(|_| "python3".into())
}

impl Loaded {
    /// Starts a Python and has it load a file, which runs its code.
    ///
    /// # Errors
    /// The mistake, and advice where there is any.
    pub fn open(path: &Path) -> Result<Self, (String, Option<String>)> {
        let program = program();
        let child = Command::new(&program)
            .arg("-c")
            .arg(SERVER)
            .arg(path)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn();
        let mut child = child.map_err(|e| {
            let advice = match e.kind() {
                ErrorKind::NotFound => format!("{PYTHON} names the Python that runs routines"),
                _ => format!("{PYTHON} names another Python"),
            };
            (format!("{program} cannot be started: {e}"), Some(advice))
        })?;
        let (Some(to), Some(from)) = (child.stdin.take(), child.stdout.take()) else {
            unreachable!("both are pipes");
        };
        let mut pipes = Pipes {
            child,
            to: Some(BufWriter::new(to)),
            from: BufReader::new(from),
        };
        match pipes.read() {
            Ok((b'Y', _)) => Ok(Self(Mutex::new(pipes))),
            Ok((_, text)) => Err((String::from_utf8_lossy(&text).into_owned(), None)),
            Err(_) => Err((
                format!("{program} has ended before the file was loaded"),
                None,
            )),
        }
    }

    /// Looks for a routine: by the name as it is written, in small letters, or in capitals.
    pub fn find(self: &Arc<Self>, name: &str) -> Option<Routine> {
        let names = [name.to_owned(), name.to_lowercase(), name.to_uppercase()];
        let is_there = |name: &&String| {
            let mut pipes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let answer = pipes.write(b'F', name.as_bytes());
            answer
                .and_then(|()| pipes.read())
                .is_ok_and(|a| a.0 == b'Y')
        };
        let name = names.iter().find(is_there)?;
        Some(Routine {
            name: name.clone(),
            of: Arc::clone(self),
            element: Arc::default(),
        })
    }
}

impl Routine {
    /// Calls it once, and fills its results. What is wrong ends the run.
    pub fn call(&self, of: &Asker, at: Moment<'_>, ask: &Ask<'_>, out: &mut [f64]) {
        let mut pipes = self.of.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found = self.results(&mut pipes, of, at, ask);
        match found {
            Ok(numbers) if numbers.len() == out.len() => out.copy_from_slice(&numbers),
            // the first call is for what it asks
            Ok(_) if at.is_first => (),
            // the others of a contact are nothing
            Ok(numbers)
                if numbers.len() == 1 && matches!(ask, Ask::Normal(_) | Ask::Friction(_)) =>
            {
                out[..1].copy_from_slice(&numbers);
            }
            Ok(numbers) => {
                let found = counted(numbers.len(), "number");
                let text = format!("{} returns {found}; it needs {}", self.name, out.len());
                asked::note(&text, true);
            }
            Err(text) => asked::note(&text, true),
        }
    }

    fn results(
        &self,
        pipes: &mut Pipes,
        of: &Asker,
        at: Moment<'_>,
        ask: &Ask<'_>,
    ) -> Result<Vec<f64>, String> {
        let ended = |e: std::io::Error| format!("Python has ended: {e}");
        let element = self.element(pipes, of, at.par).map_err(ended)?;
        let mut frame = element.to_le_bytes().to_vec();
        put_text(&mut frame, &self.name);
        put_arguments(&mut frame, at, ask);
        pipes.write(b'C', &frame).map_err(ended)?;
        loop {
            let (kind, bytes) = pipes.read().map_err(ended)?;
            match kind {
                b'R' => return Ok(numbers(&bytes)),
                b'E' => return Err(String::from_utf8_lossy(&bytes).into_owned()),
                _ => {
                    let answer = answer(kind, &bytes);
                    let kind = if answer.is_some() { b'v' } else { b'n' };
                    let answer = answer.unwrap_or_default();
                    let bytes: Vec<u8> = answer.iter().flat_map(|x| x.to_le_bytes()).collect();
                    pipes.write(kind, &bytes).map_err(ended)?;
                }
            }
        }
    }

    /// Returns the number of the element in the child, which is told of it once.
    fn element(&self, pipes: &mut Pipes, of: &Asker, par: &[f64]) -> std::io::Result<u32> {
        let mut element = self.element.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(number) = *element {
            return Ok(number);
        }
        let mut members = of.structure.members();
        members.insert("ID".into(), of.id.into());
        members.insert("NPAR".into(), par.len().into());
        let text = serde_json::Value::Object(members).to_string();
        pipes.write(b'D', text.as_bytes())?;
        let (_, bytes) = pipes.read()?;
        let number = bytes.first_chunk().map_or(0, |b| u32::from_le_bytes(*b));
        *element = Some(number);
        Ok(number)
    }
}

impl Pipes {
    fn write(&mut self, kind: u8, bytes: &[u8]) -> std::io::Result<()> {
        let Some(to) = &mut self.to else {
            return Err(ErrorKind::BrokenPipe.into());
        };
        to.write_all(&(1 + bytes.len() as u32).to_le_bytes())?;
        to.write_all(&[kind])?;
        to.write_all(bytes)?;
        to.flush()
    }

    fn read(&mut self) -> std::io::Result<(u8, Vec<u8>)> {
        let mut length = [0; 4];
        self.from.read_exact(&mut length)?;
        let length = u32::from_le_bytes(length) as usize;
        if length == 0 || length > LONGEST {
            return Err(ErrorKind::InvalidData.into());
        }
        let mut bytes = vec![0; length];
        self.from.read_exact(&mut bytes)?;
        let rest = bytes.split_off(1);
        Ok((bytes[0], rest))
    }
}

/// Answers a question of a routine; `None`: there is no such function.
fn answer(kind: u8, bytes: &[u8]) -> Option<Vec<f64>> {
    if kind == b'M' {
        let (ends, text) = bytes.split_first()?;
        asked::note(&String::from_utf8_lossy(text), *ends != 0);
        return Some(Vec::new());
    }
    let (length, rest) = bytes.split_first_chunk()?;
    let (name, ids) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
    let name = String::from_utf8_lossy(name);
    let ids: Vec<i32> = ids
        .as_chunks()
        .0
        .iter()
        .map(|b| i32::from_le_bytes(*b))
        .collect();
    match kind {
        b'A' => asked::ask(&name, &ids).map(|x| vec![x]),
        _ => asked::ask_array(&name, &ids),
    }
}

fn numbers(bytes: &[u8]) -> Vec<f64> {
    let all = bytes.as_chunks().0.iter();
    all.map(|b| f64::from_le_bytes(*b)).collect()
}

fn put_text(frame: &mut Vec<u8>, text: &str) {
    frame.extend((text.len() as u32).to_le_bytes());
    frame.extend(text.as_bytes());
}

/// Puts the numbers of USER and the arguments behind the element, in the order of the C convention
/// without counts: flags (`b`), whole numbers (`i`), numbers (`d`), lists (`v`).
fn put_arguments(frame: &mut Vec<u8>, at: Moment<'_>, ask: &Ask<'_>) {
    let mut put = |kind: u8, bytes: &[u8]| {
        frame.push(kind);
        frame.extend(bytes);
    };
    let list = |all: &[f64]| {
        let mut bytes = (all.len() as u32).to_le_bytes().to_vec();
        bytes.extend(all.iter().flat_map(|x| x.to_le_bytes()));
        bytes
    };
    put(b'v', &list(at.par));
    let (first, no) = ([u8::from(at.is_first)], [0]);
    if let Ask::Curve(alpha, iord) = ask {
        put(b'd', &alpha.to_le_bytes());
        put(b'i', &iord.to_le_bytes());
        put(b'b', &first);
        return;
    }
    put(b'd', &at.time.to_le_bytes());
    match ask {
        Ask::Plain(None) | Ask::Curve(..) => (),
        Ask::Plain(Some(Flag::Derivatives)) => put(b'b', &no),
        Ask::Plain(Some(Flag::Order(order))) => put(b'i', &order.to_le_bytes()),
        Ask::System(..) => put(b'b', &no),
        Ask::Coupler(disp) => put(b'v', &list(disp)),
        Ask::Normal(touch) => {
            touch.vectors().iter().for_each(|v| put(b'v', &list(*v)));
            for x in [touch.gap, touch.gap_rate, 0.0, 0.0] {
                put(b'd', &x.to_le_bytes());
            }
            put(b'b', &no);
        }
        Ask::Friction(slip) => {
            slip.vectors().iter().for_each(|v| put(b'v', &list(*v)));
            for x in [slip.normal_force, 0.0] {
                put(b'd', &x.to_le_bytes());
            }
            put(b'b', &no);
        }
    }
    put(b'b', &first);
    if let Ask::System(states, inputs) = ask {
        put(b'v', &list(states));
        put(b'v', &list(inputs));
    }
}
