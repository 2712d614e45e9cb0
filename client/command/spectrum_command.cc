#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/atomic_file.h"
#include "client/command/commands.h"
#include "client/command/exit_code.h"
#include "client/command/npz_file.h"
#include "client/command/progress_bar.h"
#include "client/command/reporter.h"
#include "client/command/service_call.h"
#include "client/message_json.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

constexpr char kSpectrumSchema[] = "marrow.spectrum/1";
constexpr char kStandardOutput[] = "-";

// The eigenvectors, one after another, with a value a vertex of the file: NaN
// for one that no face uses.
class Columns {
 public:
  static absl::StatusOr<Columns> Of(const Spectrum& spectrum,
                                    const OrderMap& order) {
    std::vector<uint32_t> points(spectrum.num_points);
    std::iota(points.begin(), points.end(), 0u);
    MARROW_ASSIGN_OR_RETURN(std::vector<uint32_t> point_of_vertex,
                            order.VertexLabelsInFileOrder(points));
    return Columns(spectrum, std::move(point_of_vertex));
  }

  std::vector<size_t> Shape() const {
    return {point_of_vertex_.size(), spectrum_.eigenvalues.size()};
  }
  size_t NumBytes() const { return sizeof(double) * Shape()[0] * Shape()[1]; }

  std::string Bytes(size_t pair) const {
    const double* values =
        spectrum_.eigenvectors.data() + pair * spectrum_.num_points;
    std::string bytes;
    bytes.reserve(sizeof(double) * point_of_vertex_.size());
    for (uint32_t point : point_of_vertex_) {
      AppendDouble(point == kNone ? std::numeric_limits<double>::quiet_NaN()
                                  : values[point],
                   bytes);
    }
    return bytes;
  }

 private:
  Columns(const Spectrum& spectrum, std::vector<uint32_t> point_of_vertex)
      : spectrum_(spectrum), point_of_vertex_(std::move(point_of_vertex)) {}

  const Spectrum& spectrum_;
  std::vector<uint32_t> point_of_vertex_;
};

std::string MakeNpy(const Spectrum& spectrum, const Columns& columns) {
  std::string bytes = NpyHeader("<f8", columns.Shape());
  bytes.reserve(bytes.size() + columns.NumBytes());
  for (size_t pair = 0; pair < spectrum.eigenvalues.size(); ++pair) {
    bytes += columns.Bytes(pair);
  }
  return bytes;
}

absl::StatusOr<std::string> MakeNpz(const Spectrum& spectrum,
                                    const Columns& columns) {
  NpzFile npz;
  MARROW_RETURN_IF_ERROR(npz.AddDoubles("eigenvalues", spectrum.eigenvalues));
  MARROW_RETURN_IF_ERROR(npz.AddDoubles("residuals", spectrum.residuals));
  MARROW_RETURN_IF_ERROR(npz.AddNumber("bound", spectrum.bound));
  MARROW_RETURN_IF_ERROR(
      npz.AddCount("count_below_bound", spectrum.count_below_bound));
  MARROW_RETURN_IF_ERROR(
      npz.AddNumber("area", spectrum.report.at("area").get<double>()));
  MARROW_RETURN_IF_ERROR(
      npz.AddText("solver_revision", spectrum.solver_revision));
  MARROW_RETURN_IF_ERROR(
      npz.Begin("eigenvectors", "<f8", columns.Shape(), columns.NumBytes()));
  for (size_t pair = 0; pair < spectrum.eigenvalues.size(); ++pair) {
    MARROW_RETURN_IF_ERROR(npz.Append(columns.Bytes(pair)));
  }
  return npz.Finish();
}

absl::Status WriteEigenvectors(const std::string& path,
                               const Spectrum& spectrum,
                               const OrderMap& order) {
  MARROW_ASSIGN_OR_RETURN(const Columns columns, Columns::Of(spectrum, order));
  if (path != kStandardOutput && !path.ends_with(".npz")) {
    return WriteFileAtomically(path, MakeNpy(spectrum, columns));
  }
  MARROW_ASSIGN_OR_RETURN(const std::string bytes, MakeNpz(spectrum, columns));
  if (path != kStandardOutput) return WriteFileAtomically(path, bytes);
  // Whether it went out is found when standard output is flushed at the end.
  std::fwrite(bytes.data(), 1, bytes.size(), stdout);
  return absl::OkStatus();
}

void Print(const SpectrumArguments& arguments, const Spectrum& spectrum) {
  if (arguments.output == kStandardOutput) return;
  if (arguments.service.json) {
    nlohmann::json line = {{"schema", kSpectrumSchema},
                           {"file", arguments.file},
                           {"eigenvalues", spectrum.eigenvalues},
                           {"solver_revision", spectrum.solver_revision},
                           {"report", spectrum.report},
                           {"timings", spectrum.timings},
                           {"cache", spectrum.cache}};
    if (!spectrum.residuals.empty()) {
      line["residuals"] = spectrum.residuals;
      line["bound"] = spectrum.bound;
      line["count_below_bound"] = spectrum.count_below_bound;
    }
    PrintJsonLine(line);
    return;
  }
  for (double eigenvalue : spectrum.eigenvalues) {
    absl::PrintF("%.17g\n", eigenvalue);
  }
}

// Specks are components too.
void WarnOfZeros(const SpectrumArguments& arguments, const Spectrum& spectrum) {
  if (arguments.service.quiet || spectrum.eigenvalues.back() > 0) return;
  absl::FPrintF(stderr,
                "marrow: %s: warning: all eigenvalues are 0: each of the "
                "mesh's components has one; ask for more pairs, or leave "
                "specks out\n",
                arguments.file);
}

absl::Status ComputeSpectrum(const SpectrumArguments& arguments,
                             ServiceCall& call) {
  if (!arguments.output.empty() && arguments.output != kStandardOutput) {
    MARROW_RETURN_IF_ERROR(CheckWritable(arguments.output));
  }
  const absl::Time deadline = arguments.service.Deadline();
  MARROW_ASSIGN_OR_RETURN(
      const Input input,
      LoadInput(arguments.file, arguments.service.quantize, deadline));
  TellWarning(arguments.service, arguments.file, input);
  MARROW_RETURN_IF_ERROR(call.Connect(deadline));
  v1::ComputeSpectrumRequest parameters;
  if (arguments.pairs) parameters.set_eigen_pairs(*arguments.pairs);
  parameters.set_include_eigenvectors(!arguments.output.empty());
  parameters.set_strict(arguments.strict);
  ProgressBar bar(!arguments.service.quiet);
  MARROW_ASSIGN_OR_RETURN(const Spectrum spectrum,
                          call.client().ComputeSpectrum(
                              input.payload, parameters, deadline - absl::Now(),
                              [&](const v1::Progress& progress) {
                                bar.Show(progress.fraction(),
                                         StageName(progress.stage()));
                              }));
  bar.Clear();
  if (!arguments.output.empty()) {
    MARROW_RETURN_IF_ERROR(
        WriteEigenvectors(arguments.output, spectrum, input.order));
  }
  Print(arguments, spectrum);
  WarnOfZeros(arguments, spectrum);
  return absl::OkStatus();
}

}  // namespace

int RunSpectrum(const SpectrumArguments& arguments) {
  ServiceCall call(arguments.service);
  const absl::Status status = ComputeSpectrum(arguments, call);
  if (status.ok() || call.interrupted()) return call.ExitCode(kExitOk);
  return TellFailure(arguments.file, status, arguments.service.json);
}

}  // namespace marrow::client
