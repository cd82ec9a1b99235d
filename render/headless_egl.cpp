// The one file that needs EGL: chosen by CMake where there is EGL, that is on Linux and its kin.

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "render/headless.h"

namespace percale {
namespace {

constexpr const char* kRemedy =
    "install a driver (Debian: apt-get install libegl1 libgl1 libgl1-mesa-dri), which draws on the CPU where there is "
    "no graphics card";

// A display is shared by all contexts of the process that use it: the last one ends it.
std::mutex displayMutex;
std::vector<std::pair<EGLDisplay, int>> displayUsers;

bool OpenDisplay(EGLDisplay display) {
  const std::lock_guard lock(displayMutex);
  for (auto& [known, users] : displayUsers) {
    if (known == display) {
      ++users;
      return true;
    }
  }
  if (!eglInitialize(display, nullptr, nullptr)) return false;
  displayUsers.emplace_back(display, 1);
  return true;
}

void CloseDisplay(EGLDisplay display) {
  const std::lock_guard lock(displayMutex);
  for (auto it = displayUsers.begin(); it != displayUsers.end(); ++it) {
    if (it->first != display) continue;
    if (--it->second == 0) {
      eglTerminate(display);
      displayUsers.erase(it);
    }
    return;
  }
}

// Whether a library is there. epoxy loads these when they are first needed and ends the program
// when it cannot.
bool IsLoadable(const char* library) {
  void* handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
  if (handle) dlclose(handle);
  return handle != nullptr;
}

bool HasExtension(EGLDisplay display, const char* name) {
  const char* all = eglQueryString(display, EGL_EXTENSIONS);
  return all && (" " + std::string(all) + " ").find(" " + std::string(name) + " ") != std::string::npos;
}

// All displays worth trying, best first. Not eglGetPlatformDisplay: epoxy looks its version up
// before anything is initialised, and aborts.
std::vector<EGLDisplay> CandidateDisplays() {
  std::vector<EGLDisplay> displays;
  if (HasExtension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
    if (HasExtension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        HasExtension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
      std::array<EGLDeviceEXT, 16> devices;
      EGLint count = 0;
      if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) {
        for (EGLint i = 0; i < count; ++i) {
          displays.push_back(
              eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
        }
      }
    }
    if (HasExtension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
      // First of all: Mesa chooses the best of its drivers here, the CPU's if need be.
      displays.insert(displays.begin(),
                      eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    }
  }
  displays.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return displays;
}

}  // namespace

struct HeadlessContext::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLSurface surface = EGL_NO_SURFACE;
  EGLContext context = EGL_NO_CONTEXT;

  ~Impl() {
    if (display == EGL_NO_DISPLAY) return;
    if (context != EGL_NO_CONTEXT && eglGetCurrentContext() == context) {
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    CloseDisplay(display);
  }

  // Fills this from `candidate`; on failure says which call failed.
  const char* Open(EGLDisplay candidate) {
    if (candidate == EGL_NO_DISPLAY || !OpenDisplay(candidate)) return "eglInitialize";
    display = candidate;
    if (!eglBindAPI(EGL_OPENGL_API)) return "eglBindAPI(EGL_OPENGL_API)";
    const bool surfaceless = HasExtension(display, "EGL_KHR_surfaceless_context");
    const EGLint configAttributes[] = {EGL_SURFACE_TYPE, surfaceless ? 0 : EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                       EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    if (!eglChooseConfig(display, configAttributes, &config, 1, &configs) || configs < 1) return "eglChooseConfig";
    const EGLint contextAttributes[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                                        3,
                                        EGL_CONTEXT_MINOR_VERSION_KHR,
                                        3,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                        EGL_NONE};
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, contextAttributes);
    if (context == EGL_NO_CONTEXT) return "eglCreateContext for OpenGL 3.3 core";
    if (!surfaceless) {
      const EGLint surfaceAttributes[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
      surface = eglCreatePbufferSurface(display, config, surfaceAttributes);
      if (surface == EGL_NO_SURFACE) return "eglCreatePbufferSurface";
    }
    if (!eglMakeCurrent(display, surface, surface, context)) return "eglMakeCurrent";
    return nullptr;
  }
};

HeadlessContext::HeadlessContext(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HeadlessContext::~HeadlessContext() = default;
HeadlessContext::HeadlessContext(HeadlessContext&&) noexcept = default;
HeadlessContext& HeadlessContext::operator=(HeadlessContext&&) noexcept = default;

Result<HeadlessContext> HeadlessContext::Create() {
  if (!IsLoadable("libEGL.so.1"))
    return MakeError(std::string("no graphics: the library libEGL.so.1 was not found; ") + kRemedy);
  if (!IsLoadable("libOpenGL.so.0") && !IsLoadable("libGL.so.1")) {
    return MakeError(std::string("no graphics: neither libOpenGL.so.0 nor libGL.so.1 was found; ") + kRemedy);
  }
  std::string failures;
  for (EGLDisplay candidate : CandidateDisplays()) {
    auto impl = std::make_unique<Impl>();
    const char* failed = impl->Open(candidate);
    if (!failed) return HeadlessContext(std::move(impl));
    if (failures.find(failed) == std::string::npos) failures += (failures.empty() ? "" : ", ") + std::string(failed);
  }
  return MakeError("no graphics: no OpenGL 3.3 context without a display is to be had (failed: " + failures + "); " +
                   kRemedy);
}

void HeadlessContext::MakeCurrent() const {
  eglMakeCurrent(impl_->display, impl_->surface, impl_->surface, impl_->context);
}

}  // namespace percale
