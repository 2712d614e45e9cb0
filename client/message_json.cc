#include "client/message_json.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace marrow::client {
namespace {

using google::protobuf::FieldDescriptor;
using nlohmann::json;

std::string EnumName(const google::protobuf::EnumValueDescriptor* value,
                     const std::string& prefix) {
  if (value == nullptr) return "unknown";
  return absl::AsciiStrToLower(value->name().substr(prefix.size()));
}

// The numbers of a message of numbers and points.
json NumbersJson(const google::protobuf::Message& message) {
  json result = json::object();
  const auto* reflection = message.GetReflection();
  const auto* descriptor = message.GetDescriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor* field = descriptor->field(i);
    json& value = result[field->name()];
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_UINT32:
        value = reflection->GetUInt32(message, field);
        break;
      case FieldDescriptor::CPPTYPE_INT32:
        value = reflection->GetInt32(message, field);
        break;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        value = reflection->GetDouble(message, field);
        break;
      default:
        result.erase(field->name());
    }
  }
  return result;
}

json PointJson(const v1::Vector3& p) {
  return json::array({p.x(), p.y(), p.z()});
}

}  // namespace

json ReportJson(const v1::MeshReport& report) {
  json result = NumbersJson(report);
  result["box_min"] = PointJson(report.box_min());
  result["box_max"] = PointJson(report.box_max());
  if (!report.has_genus()) result["genus"] = nullptr;
  result["predicted_bytes"] = report.predicted_bytes();
  result["findings"] = json::array();
  for (const v1::Finding& finding : report.findings()) {
    result["findings"].push_back({{"code", finding.code()},
                                  {"count", finding.count()},
                                  {"message", finding.message()}});
  }
  return result;
}

json TimingsJson(const v1::Timings& timings) { return NumbersJson(timings); }

json CacheJson(const v1::SpectrumUse& use) {
  json result = NumbersJson(use);
  result["outcome"] = OutcomeName(use.outcome());
  return result;
}

std::string OutcomeName(v1::CacheOutcome outcome) {
  return EnumName(v1::CacheOutcome_descriptor()->FindValueByNumber(outcome),
                  "CACHE_OUTCOME_");
}

std::string StageName(v1::Stage stage) {
  return EnumName(v1::Stage_descriptor()->FindValueByNumber(stage), "STAGE_");
}

std::string StopReasonName(v1::StopReason reason) {
  return EnumName(v1::StopReason_descriptor()->FindValueByNumber(reason),
                  "STOP_REASON_");
}

std::string HexOf(std::string_view bytes) {
  return absl::BytesToHexString(absl::string_view(bytes.data(), bytes.size()));
}

}  // namespace marrow::client
