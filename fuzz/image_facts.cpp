// SPDX-License-Identifier: MIT
#include "capture/source/image_facts.h"

#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  (void)sheen::capture::read_image_facts({bytes, size});
  return 0;
}
