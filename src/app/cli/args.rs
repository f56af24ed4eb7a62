//! The arguments of the command, for clap.

use std::path::PathBuf;

use clap::{
    ArgMatches, Args, Error, FromArgMatches, Parser, Subcommand,
    error::{ErrorKind, Result},
};

use crate::{
    app::render::Style,
    session::Tolerance,
    syntax::{ast::Unit, number},
};

/// A small language for solid modelling.
#[derive(Debug, Parser)]
#[command(name = "katachi", version, disable_help_subcommand = true)]
#[command(after_help = "Exit codes: 0 ok, 1 model error, 2 usage, 3 test failed, 5 limit hit.")]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// How diagnostics are written to standard error
    #[arg(long, global = true, value_enum, value_name = "STYLE", default_value_t)]
    #[arg(hide_possible_values = true, hide_default_value = true)]
    #[arg(help = "Diagnostics on standard error: human, short or json")]
    pub diagnostics: Style,
}

/// The subcommands. What each takes is put together only when it is asked for.
#[derive(Debug)]
pub enum Command {
    /// `katachi build`.
    Build(Build),
    /// `katachi check`.
    Check(Check),
    /// `katachi test`.
    Test(Test),
    /// `katachi measure`.
    Measure(Measure),
    /// `katachi params`.
    Params(Params),
    /// `katachi view`.
    View(View),
    /// `katachi new`.
    New(New),
}

/// A subcommand, what it is for, and its arguments.
fn subcommand<A: Args>(name: &'static str, about: &'static str) -> clap::Command {
    clap::Command::new(name).about(about).defer(arguments_of::<A>)
}

/// What arguments say about themselves gives way to what is said about the subcommand.
fn arguments_of<A: Args>(command: clap::Command) -> clap::Command {
    let about = command.get_about().cloned();
    A::augment_args(command).about(about.unwrap_or_default()).long_about(None)
}

impl Subcommand for Command {
    fn augment_subcommands(command: clap::Command) -> clap::Command {
        command.subcommands([
            subcommand::<Build>("build", "Make the meshes of a model and write them"),
            subcommand::<Check>("check", "Find mistakes without making any geometry"),
            subcommand::<Test>("test", "Run the tests of a model"),
            subcommand::<Measure>("measure", "Print volume, area, bounds and more of each part"),
            subcommand::<Params>("params", "List the parameters of a model"),
            subcommand::<View>("view", "Draw all parts of a model or mesh as one view"),
            subcommand::<New>("new", "Start a project in a new folder"),
        ])
    }

    fn augment_subcommands_for_update(command: clap::Command) -> clap::Command {
        Command::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        ["build", "check", "test", "measure", "params", "view", "new"].contains(&name)
    }
}

impl FromArgMatches for Command {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Command> {
        let Some((name, own)) = matches.subcommand() else {
            return Err(Error::new(ErrorKind::MissingSubcommand));
        };
        Ok(match name {
            "build" => Command::Build(Build::from_arg_matches(own)?),
            "check" => Command::Check(Check::from_arg_matches(own)?),
            "test" => Command::Test(Test::from_arg_matches(own)?),
            "measure" => Command::Measure(Measure::from_arg_matches(own)?),
            "params" => Command::Params(Params::from_arg_matches(own)?),
            "view" => Command::View(View::from_arg_matches(own)?),
            "new" => Command::New(New::from_arg_matches(own)?),
            _ => return Err(Error::new(ErrorKind::InvalidSubcommand)),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<()> {
        *self = Command::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Which model, with which parameters.
#[derive(Debug, Args)]
pub struct Model {
    /// The model, or - for standard input
    pub file: String,
    /// Set a parameter, or those of a JSON file
    #[arg(short = 'D', value_name = "NAME=VALUE|@FILE")]
    pub define: Vec<String>,
    /// Project root [default: nearest with katachi.toml]
    #[arg(long, value_name = "DIR")]
    pub root: Option<PathBuf>,
}

/// How solids are made.
#[derive(Debug, Args)]
pub struct Making {
    /// Chord error [default: the model's, else 0.05mm]
    #[arg(long, value_name = "LENGTH", value_parser = tolerance)]
    pub tolerance: Option<Tolerance>,
    /// Number of threads [default: one for each core]
    #[arg(short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Write how long each phase took, as JSON
    #[arg(long, value_name = "FILE")]
    pub timings: Option<PathBuf>,
}

/// `katachi build`.
#[derive(Debug, Args)]
pub struct Build {
    /// Which model.
    #[command(flatten)]
    pub model: Model,
    /// Only this output (may be repeated)
    #[arg(short, long = "part", value_name = "NAME")]
    pub part: Vec<String>,
    /// Output folder, made if missing
    #[arg(short, value_name = "DIR", default_value = "out")]
    pub output: PathBuf,
    /// Write each part as NAME.FORMAT in place of the exports
    #[arg(long, value_name = "FORMAT")]
    #[arg(
        help = "Parts as stl, stl-ascii, obj, off, ply, 3mf, glb, msh, vtu, inp, mesh, scad; views as svg, pdf, dxf"
    )]
    pub format: Option<String>,
    /// How.
    #[command(flatten)]
    pub making: Making,
}

/// `katachi check`.
#[derive(Debug, Args)]
pub struct Check {
    /// Which model.
    #[command(flatten)]
    pub model: Model,
}

/// `katachi test`.
#[derive(Debug, Args)]
pub struct Test {
    /// Which model.
    #[command(flatten)]
    pub model: Model,
    /// Only tests whose title contains this
    #[arg(long, value_name = "TEXT")]
    pub filter: Option<String>,
    /// Rewrite goldens and snapshots that differ
    #[arg(long)]
    pub update: bool,
    /// How.
    #[command(flatten)]
    pub making: Making,
}

/// `katachi measure`.
#[derive(Debug, Args)]
pub struct Measure {
    /// Which model.
    #[command(flatten)]
    pub model: Model,
    /// Only this part (may be repeated)
    #[arg(short, long = "part", value_name = "NAME")]
    pub part: Vec<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// How.
    #[command(flatten)]
    pub making: Making,
}

/// `katachi view`.
#[derive(Debug, Args)]
pub struct View {
    /// Which model; here it may be a mesh.
    #[command(flatten)]
    pub model: Model,
    /// Only this part (may be repeated)
    #[arg(short, long = "part", value_name = "NAME")]
    pub part: Vec<String>,
    /// A side, or X,Y,Z towards the eye
    #[arg(long, value_name = "SIDE", default_value = "ISO", allow_hyphen_values = true)]
    pub from: String,
    /// Perspective from here in place of --from
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub eye: Option<String>,
    /// What the eye looks at [default: 0,0,0]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub target: Option<String>,
    /// Hidden lines: off, dashed, depth:K
    #[arg(long, value_name = "HOW", default_value = "off")]
    pub hidden: String,
    /// Print the model, or its half-tone, as characters
    #[arg(long, conflicts_with = "output")]
    pub text: bool,
    /// How many in a row [default: those of the terminal]
    #[arg(long, value_name = "N", requires = "text")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub columns: Option<u32>,
    /// The .svg, .pdf or .dxf [default: out/MODEL.svg]
    #[arg(short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// How.
    #[command(flatten)]
    pub making: Making,
}

/// `katachi params`.
#[derive(Debug, Args)]
pub struct Params {
    /// Which model.
    #[command(flatten)]
    pub model: Model,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// `katachi new`.
#[derive(Debug, Args)]
pub struct New {
    /// The folder to make; its name is the project's
    pub name: PathBuf,
}

/// A length as the language writes it, such as `0.02mm`, or a bare number of millimetres; greater than
/// zero.
fn tolerance(text: &str) -> Result<Tolerance, String> {
    let needed = || "a length is needed, such as 0.02mm".to_string();
    let whole =
        text.starts_with(|c: char| c.is_ascii_digit()) && number::measure(text).end == text.len();
    let read = whole.then(|| number::read(text)).and_then(Result::ok);
    let millimetres = match read.ok_or_else(needed)? {
        (value, None) => value,
        (value, Some(Unit { name, exponent: 1 })) => {
            number::scaled(value, name.millimetres().ok_or_else(needed)?)
        }
        _ => return Err(needed()),
    };
    Tolerance::new(millimetres).ok_or_else(|| "a length greater than zero is needed".into())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_definition_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_tolerance_is_a_length_above_zero() {
        let mm = |text| tolerance(text).map(Tolerance::mm);
        assert_eq!(mm("0.02mm"), Ok(0.02));
        assert_eq!(mm("20um"), Ok(0.02));
        assert_eq!(mm("0.5"), Ok(0.5));
        assert_eq!(mm("0.001in"), Ok(0.0254));
        for bad in
            ["0mm", "-1mm", "1mm^2", "1 mm", "0.1mmm", "nan", "inf", "1deg", "mm", "", "1e999"]
        {
            assert!(mm(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn each_help_fits_a_screen() {
        let mut command = Cli::command().term_width(80);
        command.build();
        let names: Vec<String> =
            command.get_subcommands().map(|c| c.get_name().to_string()).collect();
        let mut pages = vec![command.render_help().to_string()];
        for name in names {
            let sub = command.find_subcommand_mut(&name).expect("listed");
            pages.push(sub.clone().term_width(80).render_help().to_string());
        }
        for page in pages {
            assert!(page.lines().count() <= 24, "too long:\n{page}");
            assert!(page.lines().all(|line| line.chars().count() <= 80), "too wide:\n{page}");
        }
    }
}
