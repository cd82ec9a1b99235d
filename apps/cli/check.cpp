#include <cstdio>

#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "io/atomic_file.h"
#include "percale/scene_file.h"

namespace percale::cli {

int Check(const Options& options) {
  if (options.schema) {
    std::printf("%s\n", SceneSchema().c_str());
    return kDone;
  }
  if (options.intersections) return CheckIntersections(options);
  std::vector<std::string> files = options.files;
  if (files.empty()) files.emplace_back();  // the default scene
  int code = kDone;
  for (const std::string& name : files) {
    Options one = options;
    one.scene = name;
    const auto opened = OpenSession(one);
    if (const int* failure = std::get_if<int>(&opened)) {
      if (*failure != kDone) code = *failure;
      continue;
    }
    const Session& session = std::get<Session>(opened);
    std::printf("%s: ok\n", PathText(session.file).c_str());
  }
  return code;
}

}  // namespace percale::cli
