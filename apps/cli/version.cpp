#include <cstdio>

#include "apps/cli/verbs.h"

namespace percale::cli {

int Version() {
  std::printf("percale %s\n", PERCALE_VERSION);
  return kDone;
}

}  // namespace percale::cli
