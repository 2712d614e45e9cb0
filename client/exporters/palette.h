// One colour a segment, the same in every file and picture.
#ifndef MARROW_CLIENT_EXPORTERS_PALETTE_H_
#define MARROW_CLIENT_EXPORTERS_PALETTE_H_

#include <cstdint>

namespace marrow {

// An sRGB colour.
struct Rgb {
  uint8_t red = 0;
  uint8_t green = 0;
  uint8_t blue = 0;

  friend bool operator==(const Rgb&, const Rgb&) = default;
};

// The colour of the node `id`. It depends on nothing but the id. Ids less than
// 16 apart have colours that a person tells apart; siblings, whose ids are
// consecutive, are far apart in hue.
Rgb SegmentColor(uint32_t id);

}  // namespace marrow

#endif  // MARROW_CLIENT_EXPORTERS_PALETTE_H_
