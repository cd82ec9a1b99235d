// The headers of the standard library that most files include, compiled once per build (options.cmake). Each file still
// includes what it uses: with PERCALE_PRECOMPILE=OFF, or ccache, this one is not there.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>
