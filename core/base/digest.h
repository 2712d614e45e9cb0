// SHA-256 digests, the keys of everything that Marrow keeps.
#ifndef MARROW_CORE_BASE_DIGEST_H_
#define MARROW_CORE_BASE_DIGEST_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace marrow {

struct Digest {
  std::array<uint8_t, 32> bytes{};

  // 64 lower-case hexadecimal digits.
  std::string Hex() const;

  friend bool operator==(const Digest&, const Digest&) = default;
  friend auto operator<=>(const Digest&, const Digest&) = default;
  template <typename H>
  friend H AbslHashValue(H h, const Digest& d) {
    return H::combine(std::move(h), d.bytes);
  }
};

// Collects bytes and gives their SHA-256. Not thread safe. One use: nothing
// may be added after Finish().
class DigestBuilder {
 public:
  // The tag separates the domains: equal content under two tags has two
  // digests. An empty tag gives the plain SHA-256 of the content.
  explicit DigestBuilder(std::string_view domain_tag);
  ~DigestBuilder();
  DigestBuilder(const DigestBuilder&) = delete;
  DigestBuilder& operator=(const DigestBuilder&) = delete;

  void Add(const void* data, size_t size);
  void AddU64(uint64_t value);  // eight bytes, little-endian
  // Length first, so that ("ab", "c") and ("a", "bc") differ.
  void AddString(std::string_view value);
  Digest Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Plain SHA-256 of `bytes`.
Digest Sha256(std::string_view bytes);

}  // namespace marrow

#endif  // MARROW_CORE_BASE_DIGEST_H_
