// Where there is no EGL (macOS, Windows): a window that is never shown.

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <string>
#include <utility>

#include "render/headless.h"

namespace percale {

struct HeadlessContext::Impl {
  GLFWwindow* window = nullptr;
  // GLFW stays initialised: the program may have a window of its own, and ending GLFW would close it.
  ~Impl() {
    if (window) glfwDestroyWindow(window);
  }
};

HeadlessContext::HeadlessContext(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HeadlessContext::~HeadlessContext() = default;
HeadlessContext::HeadlessContext(HeadlessContext&&) noexcept = default;
HeadlessContext& HeadlessContext::operator=(HeadlessContext&&) noexcept = default;

Result<HeadlessContext> HeadlessContext::Create() {
  const auto fail = [](const std::string& what) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    return MakeError("no graphics: " + what + (reason ? std::string(" (") + reason + ")" : std::string()) +
                     "; run in a session with a display, and install the graphics driver for OpenGL 3.3 or newer");
  };
  if (!glfwInit()) return fail("the window system cannot be reached");
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  auto impl = std::make_unique<Impl>();
  impl->window = glfwCreateWindow(16, 16, "percale", nullptr, nullptr);
  glfwDefaultWindowHints();
  if (!impl->window) return fail("no OpenGL 3.3 core context is to be had");
  glfwMakeContextCurrent(impl->window);
  return HeadlessContext(std::move(impl));
}

void HeadlessContext::MakeCurrent() const {
  glfwMakeContextCurrent(impl_->window);
}

}  // namespace percale
