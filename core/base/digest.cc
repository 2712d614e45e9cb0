#include "core/base/digest.h"

#include <openssl/evp.h>

#include "absl/strings/escaping.h"
#include "absl/strings/string_view.h"

namespace marrow {

struct DigestBuilder::State {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context{
      EVP_MD_CTX_new(), &EVP_MD_CTX_free};
};

std::string Digest::Hex() const {
  return absl::BytesToHexString(absl::string_view(
      reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

DigestBuilder::DigestBuilder(std::string_view domain_tag)
    : state_(std::make_unique<State>()) {
  EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr);
  if (!domain_tag.empty()) AddString(domain_tag);
}

DigestBuilder::~DigestBuilder() = default;

void DigestBuilder::Add(const void* data, size_t size) {
  EVP_DigestUpdate(state_->context.get(), data, size);
}

void DigestBuilder::AddU64(uint64_t value) {
  uint8_t bytes[8];
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<uint8_t>(value >> (8 * i));
  Add(bytes, sizeof(bytes));
}

void DigestBuilder::AddString(std::string_view value) {
  AddU64(value.size());
  Add(value.data(), value.size());
}

Digest DigestBuilder::Finish() {
  Digest digest;
  EVP_DigestFinal_ex(state_->context.get(), digest.bytes.data(), nullptr);
  return digest;
}

Digest Sha256(std::string_view bytes) {
  DigestBuilder builder("");
  builder.Add(bytes.data(), bytes.size());
  return builder.Finish();
}

}  // namespace marrow
