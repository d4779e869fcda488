//! The files of a run: tables that grow while it goes on, and what is written when it is over.

use super::writing::{WritingArgs, remark_on_kept};
use super::{Failure, animate, linear, remark, summary};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use cognate::analysis::session::Session;
use cognate::analysis::work_limit::ProcessClock;
use cognate::diagnostic::{Diagnostic, Error};
use cognate::internals::motion::marker_digest;
use cognate::internals::results::output_folder::OutputFolder;
use cognate::model::{Model, SettingsStatement};
use cognate::results::format::{Format, Sink, Style};
use cognate::results::{Run, json, msg};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Numbers that a run holds at most before they go to its files.
const MOST_HELD: usize = 1 << 21;
/// Time after which rows go to the disk, where they outlive this process.
const LONGEST_IN_MEMORY: Duration = Duration::from_secs(1);
/// Numbers of the largest run that has a `.res`, `.req` or `.gra` file without being asked for it:
/// some 200 MB.
pub const MOST_IN_RES: usize = 10_000_000;

/// The wishes of a user about files.
#[derive(clap::Args, Clone)]
pub struct FileArgs {
    /// Formats of the tables [default: csv, and those that the dataset asks for if they have no
    /// more than 10 million numbers: res by RESULTS, req by OUTPUT/REQSAVE, gra by OUTPUT/GRSAVE]
    #[arg(long = "format", value_name = "NAME", value_delimiter = ',', value_parser = table_formats(), ignore_case = true)]
    pub formats: Vec<Format>,
    /// Write a page that shows the run in motion, too (NAME.html)
    #[arg(long)]
    pub animate: bool,
    /// Open that page in the browser
    #[arg(long, requires = "animate")]
    pub open: bool,
    #[command(flatten)]
    style: StyleArgs,
    #[command(flatten)]
    writing: WritingArgs,
    /// Take names in command files as they stand, also where they lead out of the folder of results
    #[arg(long)]
    pub trust_paths: bool,
}

/// The wishes of a user about the look of tables.
#[derive(clap::Args, Clone)]
pub struct StyleArgs {
    /// No row of units below the names in .csv files
    #[arg(long)]
    no_units: bool,
    /// Numbers with a comma, and ; between them, in .csv files
    #[arg(long)]
    decimal_comma: bool,
}

impl StyleArgs {
    /// Returns the style.
    pub fn style(&self) -> Style {
        Style {
            units: !self.no_units,
            decimal_comma: self.decimal_comma,
        }
    }
}

impl FileArgs {
    /// Returns the formats that are written: those of the user, else those that RESULTS and OUTPUT
    /// ask for.
    fn chosen(&self, model: &Model) -> Vec<Format> {
        if !self.formats.is_empty() {
            return self.formats.clone();
        }
        let output = model.settings.get(&SettingsStatement::Output);
        let says = |word: &str| output.is_some_and(|o| o.words.contains_key(word));
        let results = model.settings.contains_key(&SettingsStatement::Results);
        let wanted = [
            (Format::Csv, true),
            (Format::Res, results),
            (Format::Req, says("REQSAVE")),
            (Format::Gra, says("GRSAVE")),
        ];
        wanted
            .into_iter()
            .filter_map(|(format, is_wanted)| is_wanted.then_some(format))
            .collect()
    }

    /// Returns whether the files need a format.
    pub fn need(&self, model: &Model, format: Format) -> bool {
        self.chosen(model).contains(&format)
    }
}

/// Reads the format of a table by its name.
pub fn table_formats() -> impl TypedValueParser<Value = Format> {
    PossibleValuesParser::new(Format::names(true)).try_map(|name| {
        let row = Format::row(&name.to_lowercase());
        row.map(|row| row.format).ok_or("there is no such format")
    })
}

/// A table of a run that is being written.
struct Table {
    name: String,
    sink: Box<dyn Sink>,
    /// numbers beyond which it is given up
    most: usize,
}

/// The tables of a run, shared by the run that fills them and the command that completes them.
#[derive(Clone)]
pub struct Tables(Arc<Mutex<Growing>>);

/// The tables of a run that goes on.
struct Growing {
    folder: OutputFolder,
    tables: Vec<Table>,
    /// rows that the tables have taken
    taken: usize,
    /// when the run began
    started: ProcessClock,
    /// when rows last went to the disk
    flushed: Instant,
    /// whether the folder knows that this run is being written
    is_claimed: bool,
    /// whether a page shows the run in motion, which needs all of its rows
    is_animated: bool,
    overview: summary::Overview,
    /// why nothing more can be written
    failed: Option<Diagnostic>,
}

impl Tables {
    /// Opens the tables of a session in a folder (`None`: this one), and lets it fill them. The
    /// clock tells since when the run goes on; `more`: names of files that come
    /// when it is over.
    ///
    /// # Errors
    /// When no file can be made there, or files of somebody else stand in the way.
    pub fn open(
        args: &FileArgs,
        (dir, more): (Option<&Path>, &[String]),
        session: &mut Session,
        started: ProcessClock,
    ) -> Result<Self, Error> {
        let base = session.run.name.as_str();
        let folder = OutputFolder::open(dir.unwrap_or(Path::new("")), base)?;
        let folder = folder.with_leave(args.writing.leave(), args.trust_paths);
        let asked = !args.formats.is_empty();
        let formats = args.chosen(&session.model);
        let mut tables = Vec::new();
        for row in cognate::results::format::FORMATS {
            let Some(sink) = row.sink.filter(|_| formats.contains(&row.format)) else {
                continue;
            };
            let name = table_name(base, row.name);
            let is_limited = row.format != Format::Csv && !asked;
            tables.push(Table {
                sink: sink(args.style.style(), &folder.path(&name)),
                name,
                most: if is_limited { MOST_IN_RES } else { usize::MAX },
            });
        }
        let named = tables.iter().map(|table| table.name.clone());
        folder.check(&named.chain(more.to_vec()).collect::<Vec<_>>())?;
        let tables = Self(Arc::new(Mutex::new(Growing {
            folder,
            tables,
            taken: 0,
            started,
            flushed: Instant::now(),
            is_claimed: false,
            is_animated: args.animate,
            overview: summary::Overview::default(),
            failed: None,
        })));
        let receiver = tables.clone();
        session.receive(Box::new(move |run| receiver.look(run)));
        Ok(tables)
    }

    fn growing(&self) -> MutexGuard<'_, Growing> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the rows of a run that are new, when there are many or it is time.
    pub fn look(&self, run: &mut Run) {
        let mut growing = self.growing();
        if growing.failed.is_none() {
            let looked = growing.look(run);
            growing.failed = looked.err();
        }
    }

    /// Returns whether nothing more can be written.
    pub fn have_failed(&self) -> bool {
        self.growing().failed.is_some()
    }

    /// Writes what is left, and all other files of the run; returns their names, and the record.
    /// The record comes last, so that its status shows that the others are complete.
    ///
    /// # Errors
    /// When a file cannot be written, or could not be while the run went on.
    pub fn complete(
        &self,
        session: &mut Session,
        picture: bool,
    ) -> Result<(Vec<PathBuf>, String), Failure> {
        let mut growing = self.growing();
        if let Some(failed) = growing.failed.take() {
            return Err(failed.into());
        }
        Ok(growing.complete(session, picture)?)
    }

    /// Writes what is left of a run that another thread still works on, as [`Tables::complete`],
    /// but for what only its session knows; returns the names of the files.
    ///
    /// # Errors
    /// When a file cannot be written, or could not be while the run went on.
    pub fn complete_early(&self, run: &mut Run) -> Result<Vec<PathBuf>, Diagnostic> {
        let mut growing = self.growing();
        if let Some(failed) = growing.failed.take() {
            return Err(failed);
        }
        growing.finish(run, Vec::new(), false)?;
        Ok(growing.folder.files().to_vec())
    }

    /// Prints a few rows of the table.
    pub fn overview(&self, run: &Run) -> String {
        let n_rows = run.table_rows().count();
        let width = super::width::columns();
        let growing = &mut self.growing();
        summary::table(
            growing.overview.of(run),
            n_rows,
            width,
            "the files have all",
        )
    }
}

/// Returns the name of a table: that of the record is not free.
pub fn table_name(base: &str, format: &str) -> String {
    match format {
        "json" => format!("{base}.table.json"),
        other => format!("{base}.{other}"),
    }
}

impl Growing {
    fn look(&mut self, run: &mut Run) -> Result<(), Diagnostic> {
        let is_full = run.held().len() * run.columns.len() > MOST_HELD;
        let is_due = self.flushed.elapsed() > LONGEST_IN_MEMORY;
        if !is_full && !is_due {
            return Ok(());
        }
        // before any row is on the disk: tables write large blocks as soon as they are full
        if !std::mem::replace(&mut self.is_claimed, true) {
            self.folder.claim(&[])?;
        }
        self.take(run)?;
        if is_due {
            for table in &mut self.tables {
                table.sink.flush(run)?;
            }
            self.flushed = Instant::now();
        }
        if is_full && !self.is_animated {
            self.overview.take(run);
            run.release();
        }
        Ok(())
    }

    /// Hands rows that are new to the tables.
    fn take(&mut self, run: &Run) -> Result<(), Diagnostic> {
        let rows = self.taken..run.rows();
        self.taken = rows.end;
        let numbers = rows.end.saturating_mul(run.columns.len());
        for table in self.tables.extract_if(.., |t| numbers > t.most) {
            remark(format!(
                "{} is left out: more than {} million numbers; --format writes it",
                table.name,
                MOST_IN_RES / 1_000_000
            ));
        }
        for table in self.tables.iter_mut().filter(|_| !rows.is_empty()) {
            self.folder.place(&table.name)?;
            table.sink.rows(run, rows.clone())?;
        }
        Ok(())
    }

    fn complete(
        &mut self,
        session: &mut Session,
        picture: bool,
    ) -> Result<(Vec<PathBuf>, String), Diagnostic> {
        session.run.record.markers = marker_digest(&session.model);
        let mut texts = linear::files(session);
        texts.extend(session.saved.iter().map(|(n, t)| (n.clone(), t.clone())));
        if self.is_animated {
            let page = animate::page_of_run(&session.model, &session.run, &session.folders)?;
            texts.push((format!("{}.html", session.run.name), page));
        }
        let record = self.finish(&mut session.run, texts, picture)?;
        Ok((self.folder.files().to_vec(), record))
    }

    /// Writes what is left of the tables, further texts, and the record, which it returns.
    fn finish(
        &mut self,
        run: &mut Run,
        more: Vec<(String, String)>,
        picture: bool,
    ) -> Result<String, Diagnostic> {
        let clock = Instant::now();
        // tables
        self.take(run)?;
        let mut files = Vec::new();
        for table in &mut self.tables {
            self.folder.place(&table.name)?;
            files.push((table.name.clone(), table.sink.finish(run)?));
        }
        // texts
        let own = |ending: &str| format!("{}.{ending}", run.name);
        let mut texts = vec![(own("msg"), msg::write(run))];
        texts.extend(more);
        if picture && let Some(text) = summary::picture(self.overview.of(run)) {
            texts.push((own("svg"), text));
        }
        let mut failed = None;
        for (name, text) in texts {
            match self.folder.prepare(&name, &text) {
                Ok(file) => files.push((name, file)),
                Err(d) => failed = failed.or(Some(d)),
            }
        }
        // their places
        let failed = failed.or(self.folder.put(&files).err());
        let tables = Format::names(true).into_iter();
        let mut mine: Vec<String> = tables.map(|f| table_name(&run.name, f)).collect();
        mine.extend(["msg", "svg", "html"].map(own));
        let linear = format!("{}_linear", run.name);
        mine.extend(
            self.folder
                .earlier()
                .filter(|n| n.starts_with(&linear))
                .cloned(),
        );
        self.folder.put_stale_aside(&mine)?;
        self.folder.keep_claims();
        // the record
        let seconds = &mut run.record.seconds;
        seconds.write = clock.elapsed().as_secs_f64();
        seconds.total = self.started.elapsed().as_secs_f64();
        seconds.processor = self.started.seconds();
        let record = json::with_files(json::record(run), &self.folder);
        let record = json::text(&record);
        self.folder.put_record(&record)?;
        for (was, is) in self.folder.kept() {
            remark_on_kept(was, is);
        }
        for table in &self.tables {
            if let Some(part) = self.folder.left_part(&table.name) {
                let part = cognate::disk::text(&part);
                remark(format!(
                    "{part} holds rows of a run that was ended from outside"
                ));
            }
        }
        match failed {
            None => Ok(record),
            Some(d) => Err(d.help("the other files of the run are written")),
        }
    }
}
