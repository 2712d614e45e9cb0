// CRC-32C (Castagnoli), the checksum of every chunk on the wire.
#ifndef MARROW_CORE_BASE_CRC32C_H_
#define MARROW_CORE_BASE_CRC32C_H_

#include <cstdint>
#include <string_view>

namespace marrow {

// The CRC-32C of `bytes` as iSCSI, gRPC and Google Cloud Storage define it:
// Crc32c("123456789") is 0xE3069283, that of nothing is 0.
uint32_t Crc32c(std::string_view bytes);

}  // namespace marrow

#endif  // MARROW_CORE_BASE_CRC32C_H_
