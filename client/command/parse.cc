#include "client/command/parse.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/command/arguments.h"
#include "client/command/commands.h"
#include "client/command/cut_text.h"
#include "client/command/exit_code.h"
#include "client/command/number_text.h"
#include "client/encoder/encode.h"

namespace marrow::client {
namespace {

constexpr char kAbout[] =
    "Splits meshes of creatures into a tree of parts, with a skeleton a "
    "level.\n\n"
    "Meshes are OFF, OBJ, PLY, STL, glTF, GLB or Draco files; - is standard "
    "input, of whichever format.";

constexpr char kFooter[] = R"(Examples:
  marrow sample humanoid --pose wave -o me.off    a creature to try
  marrow segment me.off --png -o out              its parts, and pictures
  marrow segment a.obj b.glb --server host:50051  on a server
  marrow inspect me.off                           what is in a file
`marrow SUBCOMMAND --help` tells more.

Exit codes:
  0    all went well
  1    a file failed; the others are done
  2    the command line asks for something impossible
  3    the server cannot be reached, or was lost
  130  stopped by Ctrl-C (128 + the signal's number)

Environment:
  MARROW_SERVER  the server to use where --server is not given. Without
                 either, the work is done in this process.)";

constexpr char kSegmentFooter[] =
    R"(For FILE = path/STEM.ext these appear in DIR, all together or not at all:
  STEM.seg            the cut that --cut asks for: one label a face and line,
                      in the file's face order
  STEM.cut.seg        the same again, beside its
  STEM.level-N.seg    likes for each level; 1 is the coarsest
  STEM.cut.ply, STEM.level-N.ply
                      the mesh coloured by segment, on faces and vertices
  STEM.json           tree, cut, skeletons, a report on the mesh, timings
  STEM.cut.png, STEM.level-N.png
                      with --png: a picture with the skeleton
  STEM.parts.obj      with --parts: each segment of the cut an object
Labels are the ids of the tree's nodes in STEM.json, and, of segments of the
cut that are no nodes, those in its "cut". What an earlier run wrote for STEM,
as STEM.json lists it, is replaced as a whole; a file of another's is written
over where it has one of these names, and is left alone otherwise. The STEM of
standard input (-) is stdin.

With --json each event is a line {"event": ..., "file": ...} on standard
output: accepted, progress, mesh_report, level, skeleton, warning, cut, then
completed (with the files that were written) or error; at last one summary.
A large level or skeleton comes in several lines, whose numbers add up.
Lines of several files may alternate. A failure is told on standard error too.

Ctrl-C stops the work and leaves no file half written; a second one, or two
seconds more, ends it at once.)";

constexpr char kCutFooter[] =
    R"(The server has to have segmented FILE with the same options before, and not to
have forgotten it since; the answer then takes milliseconds. Without a server
the file is segmented anew. For FILE = path/STEM.ext these appear in DIR:
  STEM.cut.seg        one label a face and line, in the file's face order
  STEM.cut.ply        the mesh coloured by segment, on faces and vertices
  STEM.cut.json       the segments and the skeleton
  STEM.cut.png        with --png: a picture with the skeleton
  STEM.cut.parts.obj  with --parts: each segment an object
What an earlier run wrote of these is replaced, other results of STEM are left
alone.)";

constexpr char kSpectrumFooter[] =
    R"(Prints the eigenvalues of the Laplace-Beltrami operator, ascending, one a line,
the constant function's 0 first. Units are those of the file: an eigenvalue is
1 over a length squared, and the square of an eigenvector has the integral 1.

-o FILE.npz writes an archive for numpy.load, with the arrays
  eigenvalues        as printed
  eigenvectors       float64, a row a vertex of the file, a column a pair; NaN
                     for a vertex that no face uses
  residuals          of each pair |L phi - lambda M phi| in the norm of M^-1, in
                     units of lambda (of the first that is not 0 at the least)
  bound, count_below_bound
                     the certificate: so many eigenvalues, counted by inertia,
                     are below bound, and as many of those listed
  area               of the surface
  solver_revision    other pairs may come where it is another
-o FILE.npy writes the eigenvectors alone. -o - writes the archive to standard
output, and nothing else. A file appears whole or not at all.

Residuals are about 1e-4, with --strict at most 1e-8, which takes up to twice
the work and is not kept in a server's cache. -o refines the pairs together, so
that their last digits may depend on how many there are.

Pieces that do not touch, specks too, are solved for on their own: each has an
eigenvalue 0, and its eigenvectors are 0 on the others. Segmentation joins pieces
that are near before it solves.)";

constexpr char kHealthFooter[] =
    R"(Exit code 0 where the server takes calls, 1 where it answers that it does not,
3 where nothing answers.)";

// Checks of an option's text: empty where it is well.

std::string CheckNumber(const std::string& text) {
  double value = 0;
  return ReadNumber(text, value) ? ""
                                 : absl::StrCat("'", text, "' is no number");
}

std::string CheckWholeNumber(const std::string& text) {
  uint32_t value = 0;
  return ReadWholeNumber(text, value)
             ? ""
             : absl::StrCat("'", text, "' is no whole number");
}

std::string CheckSeconds(const std::string& text) {
  double value = 0;
  return ReadNumber(text, value) && value > 0
             ? ""
             : absl::StrCat("'", text, "' is no number of seconds above 0");
}

std::string CheckBits(const std::string& text) {
  uint32_t bits = 0;
  return ReadWholeNumber(text, bits) && bits >= 1 &&
                 bits <= kMaxQuantizationBits
             ? ""
             : absl::StrCat("'", text, "' is no number of bits from 1 to ",
                            kMaxQuantizationBits,
                            "; without the option all are sent");
}

std::string CheckThreads(const std::string& text) {
  uint32_t threads = 0;
  return ReadWholeNumber(text, threads) && threads >= 1 &&
                 threads <= kMaxFilesAtOnce
             ? ""
             : absl::StrCat("'", text, "' is no number from 1 to ",
                            kMaxFilesAtOnce);
}

std::string CheckFile(const std::string& text) {
  return !text.empty() ? "" : "the name is empty; name a mesh file";
}

std::string CheckFolder(const std::string& text) {
  return text != "-" ? ""
                     : "results are several files, which standard output "
                       "cannot hold: name a folder (./- for one named -)";
}

void AddVersion(CLI::App& app) {
  app.set_version_flag("--version", "marrow " MARROW_VERSION,
                       "Print the version and exit");
}

void AddServer(CLI::App& app, std::string& server, const char* otherwise) {
  app.add_option(
         "--server", server,
         std::string("HOST:PORT of a marrowd; without it, ") + otherwise)
      ->envname("MARROW_SERVER")
      ->type_name("ADDR");
}

void AddService(CLI::App& app, ServiceArguments& service) {
  AddServer(app, service.server, "the work is done in this process");
  app.add_option("--timeout", service.timeout,
                 "Give a file up after this many seconds, from reading it to "
                 "its last picture")
      ->check(CheckSeconds)
      ->type_name("SECONDS");
  app.add_option("--quantize", service.quantize,
                 absl::StrCat("Send coordinates with this many bits, 1 to ",
                              kMaxQuantizationBits, "; without it exactly"))
      ->check(CheckBits)
      ->type_name("BITS");
  app.add_flag("--json", service.json, "Write JSON to standard output");
}

void AddQuiet(CLI::App& app, bool& quiet) {
  app.add_flag("-q,--quiet", quiet, "Tell nothing but failures");
}

void AddPairs(CLI::App& app, const std::string& names,
              std::optional<uint32_t>& pairs) {
  app.add_option(names, pairs,
                 "Eigen-pairs besides the constant one, 2 to 1000 (200)")
      ->check(CheckWholeNumber)
      ->type_name("N");
}

// METHOD_UNSPECIFIED for a name of none.
v1::Method MethodOf(const std::string& name) {
  if (name == "merge") return v1::METHOD_MERGE;
  return name == "paper" ? v1::METHOD_PAPER : v1::METHOD_UNSPECIFIED;
}

std::string CheckMethod(const std::string& name) {
  return MethodOf(name) != v1::METHOD_UNSPECIFIED
             ? ""
             : absl::StrCat("'", name, "' is neither merge nor paper");
}

// A value's range is the server's business, so that there is one place for it.
void AddMethod(CLI::App& app, MethodArguments& arguments) {
  app.add_option_function<std::string>(
         "--method",
         [&arguments](const std::string& name) {
           arguments.method = MethodOf(name);
         },
         "merge: merge pieces across their weakest boundaries; paper: "
         "split from the top (merge)")
      ->check(CheckMethod)
      ->type_name("NAME");
  app.add_option("--kappa", arguments.kappa,
                 "Of --method paper: higher gives fewer segments, 0.1 to 10 "
                 "(1.5)")
      ->check(CheckNumber)
      ->type_name("X");
  app.add_option("--delta", arguments.delta,
                 "Where the diffusion map is cut, 0.001 to 0.999 (0.1)")
      ->check(CheckNumber)
      ->type_name("X");
  app.add_option("--epsilon", arguments.epsilon,
                 "How thick medial structures are, 0 to 1 (0.01)")
      ->check(CheckNumber)
      ->type_name("X");
  app.add_option("--tolerance", arguments.tolerance,
                 "Share of faces that may still move, 0 to 0.5 (0.01)")
      ->check(CheckNumber)
      ->type_name("X");
  AddPairs(app, "--pairs", arguments.pairs);
  app.add_option("--levels", arguments.levels,
                 "Depth of the tree, 1 to 8; merged pieces have 3 (3)")
      ->check(CheckWholeNumber)
      ->type_name("N");
}

// Ids with commas between them in one word, so that a file may follow; several
// such options add up.
void AddIds(CLI::App& app, const std::string& name, std::vector<uint32_t>& ids,
            const std::string& about) {
  app.add_option(name, ids, about)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CheckWholeNumber)
      ->type_name("IDS");
}

void CheckNodes(const CutChoice& cut) {
  for (const uint32_t id : cut.open) {
    if (std::count(cut.closed.begin(), cut.closed.end(), id) == 0) continue;
    throw CLI::ValidationError("--open",
                               absl::StrCat("is ", id,
                                            ", and so is --closed: a node is "
                                            "held open or closed"));
  }
}

void AddCut(CLI::App& app, CutChoice& arguments) {
  app.add_option("--cut", arguments.text,
                 "Which segments of the tree to take: auto, level:N, "
                 "segments:N (at most N) or salience:X, 0 to 1 (auto)")
      ->check(CheckCutText)
      ->type_name("CUT");
  AddIds(app, "--closed", arguments.closed,
         "Ids of nodes that the cut never splits, such as 3,7");
  AddIds(app, "--open", arguments.open,
         "Ids of nodes that the cut splits into their children");
  app.callback([&arguments] { CheckNodes(arguments); });
}

void AddOutput(CLI::App& app, std::string& folder) {
  app.add_option("-o,--output", folder,
                 "Folder of the results, made where it is missing; without "
                 "it, the current one")
      ->check(CheckFolder)
      ->type_name("DIR");
}

void AddSegment(CLI::App& root, SegmentArguments& arguments) {
  CLI::App& app = *root.add_subcommand(
      "segment", "Split meshes into parts and write the results");
  app.add_option("FILE", arguments.files, "Mesh files")
      ->required()
      ->check(CheckFile)
      ->type_name("");
  AddOutput(app, arguments.folder);
  app.add_flag("--png", arguments.png, "Write a picture a level");
  app.add_flag("--parts", arguments.parts, "Write the parts as OBJ objects");
  AddMethod(app, arguments.method);
  AddCut(app, arguments.cut);
  AddService(app, arguments.service);
  AddQuiet(app, arguments.service.quiet);
  app.add_option("--threads", arguments.service.threads,
                 absl::StrCat("Files to work on at once, 1 to ",
                              kMaxFilesAtOnce, "; without it, one a core"))
      ->check(CheckThreads)
      ->type_name("N");
  app.footer(kSegmentFooter);
}

void AddCutCommand(CLI::App& root, CutArguments& arguments) {
  CLI::App& app = *root.add_subcommand(
      "cut", "Cut the tree of a mesh that a server has segmented, anew");
  app.add_option("FILE", arguments.file, "Mesh file, as it was segmented")
      ->required()
      ->check(CheckFile)
      ->type_name("");
  AddOutput(app, arguments.folder);
  app.add_flag("--png", arguments.png, "Write a picture");
  app.add_flag("--parts", arguments.parts, "Write the parts as OBJ objects");
  AddMethod(app, arguments.method);
  AddCut(app, arguments.cut);
  AddService(app, arguments.service);
  AddQuiet(app, arguments.service.quiet);
  app.footer(kCutFooter);
}

void AddInspect(CLI::App& root, InspectArguments& arguments) {
  CLI::App& app =
      *root.add_subcommand("inspect", "Tell what is in a mesh file");
  app.add_option("FILE", arguments.file, "Mesh file")
      ->required()
      ->check(CheckFile)
      ->type_name("");
  AddService(app, arguments.service);
  AddQuiet(app, arguments.service.quiet);
}

void AddSpectrum(CLI::App& root, SpectrumArguments& arguments) {
  CLI::App& app = *root.add_subcommand(
      "spectrum", "Print the eigenvalues of a mesh, or write its eigenvectors");
  app.add_option("FILE", arguments.file, "Mesh file")
      ->required()
      ->check(CheckFile)
      ->type_name("");
  AddPairs(app, "-k,--pairs", arguments.pairs);
  app.add_option("-o,--output", arguments.output,
                 "Write the pairs to this .npz file, or the eigenvectors to "
                 "this .npy file")
      ->type_name("FILE");
  app.add_flag("--strict", arguments.strict, "Residuals of at most 1e-8");
  AddService(app, arguments.service);
  AddQuiet(app, arguments.service.quiet);
  app.footer(kSpectrumFooter);
  app.callback([&arguments] {
    if (arguments.output == "-" && arguments.service.json) {
      throw CLI::ValidationError("--json",
                                 "cannot share standard output with "
                                 "-o -: name a file");
    }
    if (const std::string& output = arguments.output;
        !output.empty() && output != "-" && !output.ends_with(".npz") &&
        !output.ends_with(".npy")) {
      throw CLI::ValidationError(
          "--output", "'" + output + "' ends in neither .npz nor .npy");
    }
  });
}

void AddSample(CLI::App& root, SampleArguments& arguments) {
  CLI::App& app =
      *root.add_subcommand("sample", "Make a creature to try Marrow with");
  CLI::Option* list = app.add_flag("--list", arguments.list,
                                   "List the creatures and their poses");
  app.add_option("NAME", arguments.name, "Which creature")->type_name("");
  app.add_option("--pose", arguments.pose, "Its pose; without it, at rest")
      ->type_name("POSE");
  app.add_option("-o,--output", arguments.output,
                 "The mesh file: .off, .obj, .ply, .stl or .drc")
      ->type_name("FILE");
  app.add_option("--parts", arguments.parts,
                 "Write the known part of each face, as a .seg file")
      ->type_name("FILE.seg");
  app.add_option("--faces", arguments.faces,
                 "Number of faces, 5000 to 50000 (10000)")
      ->check(CheckWholeNumber)
      ->type_name("N");
  AddQuiet(app, arguments.quiet);
  app.callback([&arguments, list] {
    if (list->count() > 0) return;
    if (arguments.name.empty()) throw CLI::RequiredError("NAME (or --list)");
    if (arguments.output.empty()) throw CLI::RequiredError("-o FILE");
  });
}

void AddHealth(CLI::App& root, std::string& server) {
  CLI::App& app =
      *root.add_subcommand("health", "Ask whether a server takes calls");
  AddServer(app, server, "127.0.0.1:50051 is asked");
  app.footer(kHealthFooter);
}

struct Arguments {
  SegmentArguments segment;
  CutArguments cut;
  InspectArguments inspect;
  SpectrumArguments spectrum;
  SampleArguments sample;
  std::string health_server;
};

int Run(const CLI::App& app, const Arguments& arguments) {
  if (app.got_subcommand("segment")) return RunSegment(arguments.segment);
  if (app.got_subcommand("cut")) return RunCut(arguments.cut);
  if (app.got_subcommand("inspect")) return RunInspect(arguments.inspect);
  if (app.got_subcommand("spectrum")) return RunSpectrum(arguments.spectrum);
  if (app.got_subcommand("sample")) return RunSample(arguments.sample);
  return RunHealth(arguments.health_server);
}

// One line that says what is wrong and where help is.
std::string Complaint(const CLI::App* app, const CLI::Error& error) {
  const auto subcommands = app->get_subcommands();
  std::string what = error.what();
  if (subcommands.empty() && !app->remaining().empty() &&
      !app->remaining()[0].starts_with('-')) {
    what = absl::StrCat("there is no subcommand '", app->remaining()[0], "'");
  }
  return absl::StrCat(
      "marrow: ", what, "; see marrow ",
      subcommands.empty() ? "" : subcommands[0]->get_name() + " ", "--help\n");
}

}  // namespace

int RunCommandLine(int argc, const char* const* argv) {
  CLI::App app(kAbout, "marrow");
  Arguments arguments;
  app.require_subcommand(1);
  app.footer(kFooter);
  app.failure_message(Complaint);
  AddSegment(app, arguments.segment);
  AddCutCommand(app, arguments.cut);
  AddInspect(app, arguments.inspect);
  AddSpectrum(app, arguments.spectrum);
  AddSample(app, arguments.sample);
  AddHealth(app, arguments.health_server);
  AddVersion(app);
  for (CLI::App* subcommand : app.get_subcommands(nullptr))
    AddVersion(*subcommand);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  return Run(app, arguments);
}

}  // namespace marrow::client
