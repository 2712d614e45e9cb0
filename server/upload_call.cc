#include "server/upload_call.h"

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/crc32c.h"
#include "core/base/error_reason.h"
#include "core/base/status_macros.h"
#include "server/event_builder.h"
#include "server/request_parser.h"
#include "server/status.h"

namespace marrow {
namespace {

constexpr size_t kMaxChunkBytes = 1 << 20;
constexpr double kMinBytesASecond = 1024;

absl::Status CheckChunk(const v1::UploadMeshRequest::Chunk& chunk) {
  if (chunk.data().empty() || chunk.data().size() > kMaxChunkBytes) {
    return InvalidField("chunk.data",
                        absl::StrCat("has ", chunk.data().size(),
                                     " bytes; must be 1 to ", kMaxChunkBytes));
  }
  if (chunk.has_data_crc32c() && chunk.data_crc32c() != Crc32c(chunk.data())) {
    return InvalidField("chunk.data_crc32c",
                        absl::StrCat("does not fit the data of the chunk at ",
                                     chunk.offset(), "; send it again"));
  }
  return absl::OkStatus();
}

}  // namespace

// What gRPC and the clock share. `reactor_` is null once the call is finished;
// reactor and response are not used after that.
class UploadCall::State final : public Tickable {
 public:
  State(ServiceContext& context, grpc::CallbackServerContext& call,
        UploadCall* reactor, v1::UploadMeshResponse* response)
      : context_(context),
        record_(context, call, "MeshStoreService.UploadMesh"),
        reactor_(reactor),
        response_(response) {}

  void Begin() {
    absl::MutexLock lock(&mu_);
    if (context_.draining) return FinishLocked(Draining());
    ReadLocked();
  }

  void OnReadDone(bool ok) {
    absl::MutexLock lock(&mu_);
    if (reactor_ == nullptr) return;
    if (!ok) return FinishLocked(EndLocked());
    const absl::Status status = TakeLocked();
    if (!status.ok() || response_->already_present()) {
      return FinishLocked(status);
    }
    ReadLocked();
  }

  void OnCancel() {
    absl::MutexLock lock(&mu_);
    FinishLocked(CallCancelled());
  }

  void Tick(Clock::time_point now) override {
    absl::MutexLock lock(&mu_);
    if (record_.Expired(now)) {
      FinishLocked(DefaultDeadlineExceeded(context_.options));
    }
    const Clock::duration taken = now - record_.arrived();
    const double seconds = std::chrono::duration<double>(taken).count();
    const double received =
        upload_ == nullptr ? 0 : static_cast<double>(upload_->received());
    if (taken > context_.options.upload_stall_limit &&
        received < kMinBytesASecond * seconds) {
      FinishLocked(absl::DeadlineExceededError(
          "the upload is slower than 1 KiB a second"));
    }
  }

 private:
  void ReadLocked() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    request_.Clear();
    reactor_->StartRead(&request_);
  }

  absl::Status TakeLocked() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    if (upload_ == nullptr) return TakeHeaderLocked();
    if (!request_.has_chunk()) {
      return InvalidField("chunk",
                          "is missing; only the first message of an "
                          "upload is a header");
    }
    MARROW_RETURN_IF_ERROR(CheckChunk(request_.chunk()));
    return upload_->Add(request_.chunk().offset(), request_.chunk().data());
  }

  absl::Status TakeHeaderLocked() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    if (!request_.has_header()) {
      return InvalidField(
          "header", "is missing; the first message of an upload is a header");
    }
    MARROW_ASSIGN_OR_RETURN(
        const MeshDigest digest,
        ParseMeshDigest(request_.header(), "header", context_.options));
    record_.Describe("mesh", digest.sha256.Hex().substr(0, 12));
    MARROW_ASSIGN_OR_RETURN(const auto present, context_.store.Find(digest));
    SetMeshDigest(digest, response_->mutable_digest());
    response_->set_already_present(present != nullptr);
    upload_ = context_.store.BeginUpload(digest);
    return absl::OkStatus();
  }

  absl::Status EndLocked() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    if (upload_ == nullptr) {
      return InvalidField(
          "header", "is missing; the first message of an upload is a header");
    }
    return upload_->Finish();
  }

  void FinishLocked(const absl::Status& status)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mu_) {
    if (reactor_ == nullptr) return;
    upload_.reset();
    const grpc::Status grpc_status = ToGrpcStatus(status);
    record_.Finished(grpc_status);
    std::exchange(reactor_, nullptr)->Finish(grpc_status);
  }

  ServiceContext& context_;
  absl::Mutex mu_;
  CallRecord record_ ABSL_GUARDED_BY(mu_);
  UploadCall* reactor_ ABSL_GUARDED_BY(mu_);
  v1::UploadMeshResponse* const response_ ABSL_PT_GUARDED_BY(mu_);
  // gRPC's while a read is under way.
  v1::UploadMeshRequest request_ ABSL_GUARDED_BY(mu_);
  std::unique_ptr<MeshStore::Upload> upload_ ABSL_GUARDED_BY(mu_);
};

UploadCall::UploadCall(ServiceContext& context,
                       grpc::CallbackServerContext& call,
                       v1::UploadMeshResponse* response)
    : state_(std::make_shared<State>(context, call, this, response)) {
  context.ticker.Add(state_);
}

void UploadCall::Begin() { state_->Begin(); }
void UploadCall::OnReadDone(bool ok) { state_->OnReadDone(ok); }
void UploadCall::OnCancel() { state_->OnCancel(); }
void UploadCall::OnDone() { delete this; }

}  // namespace marrow
