#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "absl/strings/str_format.h"
#include "client/atomic_file.h"
#include "client/command/commands.h"
#include "client/command/exit_code.h"
#include "client/command/npy_file.h"
#include "client/command/progress_bar.h"
#include "client/command/reporter.h"
#include "client/command/service_call.h"
#include "client/message_json.h"
#include "core/base/status_macros.h"

namespace marrow::client {
namespace {

constexpr char kSpectrumSchema[] = "marrow.spectrum/1";

// A row a vertex of the file, NaN for one that no face uses.
absl::StatusOr<std::string> EigenvectorFile(const Spectrum& spectrum,
                                            const OrderMap& order) {
  std::vector<uint32_t> points(spectrum.num_points);
  std::iota(points.begin(), points.end(), 0u);
  MARROW_ASSIGN_OR_RETURN(const std::vector<uint32_t> point_of_vertex,
                          order.VertexLabelsInFileOrder(points));
  std::vector<double> values;
  values.reserve(point_of_vertex.size() * spectrum.eigenvalues.size());
  for (size_t pair = 0; pair < spectrum.eigenvalues.size(); ++pair) {
    for (uint32_t point : point_of_vertex) {
      values.push_back(
          point == kNone
              ? std::numeric_limits<double>::quiet_NaN()
              : spectrum.eigenvectors[pair * spectrum.num_points + point]);
    }
  }
  return NpyFile(values, point_of_vertex.size(), spectrum.eigenvalues.size());
}

void Print(const SpectrumArguments& arguments, const Spectrum& spectrum) {
  if (arguments.service.json) {
    PrintJsonLine({{"schema", kSpectrumSchema},
                   {"file", arguments.file},
                   {"eigenvalues", spectrum.eigenvalues},
                   {"report", spectrum.report},
                   {"timings", spectrum.timings},
                   {"cache", spectrum.cache}});
    return;
  }
  for (double eigenvalue : spectrum.eigenvalues) {
    absl::PrintF("%.17g\n", eigenvalue);
  }
}

absl::Status ComputeSpectrum(const SpectrumArguments& arguments,
                             ServiceCall& call) {
  MARROW_ASSIGN_OR_RETURN(
      const Input input, LoadInput(arguments.file, arguments.service.quantize));
  MARROW_RETURN_IF_ERROR(call.Connect());
  v1::ComputeSpectrumRequest parameters;
  if (arguments.pairs) parameters.set_eigen_pairs(*arguments.pairs);
  parameters.set_include_eigenvectors(!arguments.output.empty());
  ProgressBar bar(!arguments.service.quiet);
  MARROW_ASSIGN_OR_RETURN(
      const Spectrum spectrum,
      call.client().ComputeSpectrum(
          input.payload, parameters, arguments.service.Timeout(),
          [&](const v1::Progress& progress) {
            bar.Show(progress.fraction(), StageName(progress.stage()));
          }));
  bar.Clear();
  if (!arguments.output.empty()) {
    MARROW_ASSIGN_OR_RETURN(const std::string bytes,
                            EigenvectorFile(spectrum, input.order));
    MARROW_RETURN_IF_ERROR(WriteFileAtomically(arguments.output, bytes));
  }
  Print(arguments, spectrum);
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
