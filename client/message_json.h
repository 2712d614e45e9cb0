// Messages of the service as JSON, under the names of the .proto.
#ifndef MARROW_CLIENT_MESSAGE_JSON_H_
#define MARROW_CLIENT_MESSAGE_JSON_H_

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "marrow/v1/mesh.pb.h"
#include "marrow/v1/segmentation_service.pb.h"

namespace marrow::client {

// Every field of the report; points are arrays of three numbers.
nlohmann::json ReportJson(const v1::MeshReport& report);
// Every field, in seconds.
nlohmann::json TimingsJson(const v1::Timings& timings);
// outcome ("hit", "miss" or "joined"), solver_runs, eigen_pairs.
nlohmann::json CacheJson(const v1::SpectrumUse& use);

// "hit", "miss", "joined".
std::string OutcomeName(v1::CacheOutcome outcome);

// "spectrum", "one_segment": an enum's name without its prefix, in lower case;
// "unknown" for a value that this client does not know.
std::string StageName(v1::Stage stage);
std::string StopReasonName(v1::StopReason reason);

std::string HexOf(std::string_view bytes);

}  // namespace marrow::client

#endif  // MARROW_CLIENT_MESSAGE_JSON_H_
