#include "apps/viewer/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/viewer/style.h"
#include "io/atomic_file.h"
#include "render/gl_device.h"

namespace percale::viewer {
namespace {

constexpr int kAutomaticSamples = 4;

/// What GLFW said last, on the thread that calls it.
std::string& LastError() {
  static std::string text;
  return text;
}

Diagnostic NoGraphics(const std::string& what, const std::string& remedy) {
  std::string message = what;
  if (!LastError().empty()) message += " (" + std::exchange(LastError(), {}) + ")";
  return MakeError(message + "; " + remedy);
}

SpecialKey SpecialKeyOf(int key) {
  using enum SpecialKey;
  constexpr std::pair<int, SpecialKey> kKeys[] = {
      {GLFW_KEY_ESCAPE, Escape}, {GLFW_KEY_TAB, Tab},   {GLFW_KEY_ENTER, Enter}, {GLFW_KEY_KP_ENTER, Enter},
      {GLFW_KEY_DELETE, Delete}, {GLFW_KEY_HOME, Home}, {GLFW_KEY_END, End},     {GLFW_KEY_LEFT, Left},
      {GLFW_KEY_RIGHT, Right},   {GLFW_KEY_UP, Up},     {GLFW_KEY_DOWN, Down}};
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12)
    return static_cast<SpecialKey>(static_cast<int>(F1) + key - GLFW_KEY_F1);
  for (const auto& entry : kKeys) {
    if (entry.first == key) return entry.second;
  }
  return None;
}

/// The character of a key that is pressed with Ctrl, which types none: the one that it types by
/// itself, or on a keyboard of another script the one that the key has on an American one.
char CharacterWithControl(int key, int scancode) {
  const char* const name = glfwGetKeyName(key, scancode);
  if (name && name[0] > ' ' && name[0] < 0x7f && name[1] == 0) return name[0];
  return key > GLFW_KEY_SPACE && key < 0x7f ? static_cast<char>(key) : '\0';
}

/// Whether the corner of a window at that place can be seen and grasped on some screen.
bool IsOnScreen(int x, int y) {
  constexpr int kGrip = 60;
  int count = 0;
  GLFWmonitor** const monitors = glfwGetMonitors(&count);
  for (int i = 0; i < count; ++i) {
    int left = 0, top = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitors[i], &left, &top, &width, &height);
    if (x >= left && y >= top && x + kGrip <= left + width && y + kGrip <= top + height) return true;
  }
  return false;
}

}  // namespace

/// What GLFW calls. ImGui's own callbacks are installed afterwards and call these first.
struct Window::Callbacks {
  static Input& Of(GLFWwindow* window) {
    Input& input = *static_cast<Input*>(glfwGetWindowUserPointer(window));
    input.activity = true;
    return input;
  }
  static void Add(GLFWwindow* window, InputEvent event) { Of(window).events.push_back(std::move(event)); }

  static void Key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    Of(window).lastRepeated = action == GLFW_REPEAT;
    if (action == GLFW_PRESS && key >= 0) Of(window).pressed.push_back(key);
    if (action == GLFW_RELEASE || (modifiers & GLFW_MOD_ALT) != 0) return;
    InputEvent event;
    event.kind = InputEvent::Kind::Key;
    event.key.special = SpecialKeyOf(key);
    event.key.control = (modifiers & GLFW_MOD_CONTROL) != 0;
    event.key.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
    // Without Ctrl, what the key types comes by Character.
    if (event.key.control && event.key.special == SpecialKey::None)
      event.key.character = CharacterWithControl(key, scancode);
    if (!event.key) return;
    event.repeated = action == GLFW_REPEAT;
    Add(window, event);
  }
  static void Character(GLFWwindow* window, unsigned codepoint) {
    if (codepoint > 0x7e) return;  // No action has such a key.
    InputEvent event;
    event.kind = InputEvent::Kind::Key;
    event.key.character = static_cast<char>(codepoint);
    event.repeated = Of(window).lastRepeated;
    Add(window, event);
  }
  static void Button(GLFWwindow* window, int button, int action, int modifiers) {
    if (button != GLFW_MOUSE_BUTTON_LEFT && button != GLFW_MOUSE_BUTTON_RIGHT) return;
    InputEvent event;
    event.kind = action == GLFW_PRESS ? InputEvent::Kind::Press : InputEvent::Kind::Release;
    event.button = button == GLFW_MOUSE_BUTTON_LEFT ? InputEvent::Button::Left : InputEvent::Button::Right;
    event.control = (modifiers & GLFW_MOD_CONTROL) != 0;
    event.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
    // Not where the pointer is by now: a quick hand has moved on since the press.
    event.x = Of(window).x;
    event.y = Of(window).y;
    Add(window, event);
  }
  static void Move(GLFWwindow* window, double x, double y) {
    InputEvent event;
    event.x = Of(window).x = x;
    event.y = Of(window).y = y;
    Add(window, event);
  }
  static void Wheel(GLFWwindow* window, double, double steps) {
    InputEvent event;
    event.kind = InputEvent::Kind::Wheel;
    event.steps = steps;
    event.x = Of(window).x;
    event.y = Of(window).y;
    Add(window, event);
  }
  static void Drop(GLFWwindow* window, int count, const char** files) {
    for (int i = 0; i < count; ++i) {
      InputEvent event;
      event.kind = InputEvent::Kind::Drop;
      event.file = TextPath(files[i]);
      Add(window, event);
    }
  }
  static void Resized(GLFWwindow* window, int, int) { Of(window); }
  static void Scaled(GLFWwindow* window, float, float) { Of(window); }
  static void Focused(GLFWwindow* window, int) { Of(window); }
  static void Refreshed(GLFWwindow* window) { Of(window); }
};

Result<GLFWwindow*> Window::Create(const WindowSettings& settings, int samples) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_DEPTH_BITS, 24);
  glfwWindowHint(GLFW_SAMPLES, samples > 1 ? samples : 0);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "percale");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "percale");
  GLFWwindow* window = glfwCreateWindow(settings.width, settings.height, settings.title.c_str(), nullptr, nullptr);
  if (!window) {
    return NoGraphics("this display offers no OpenGL 3.3",
                      "update the graphics driver, or draw with the CPU: on Debian install libgl1-mesa-dri, then run "
                      "with LIBGL_ALWAYS_SOFTWARE=1; `percale shot` and `percale render` need no display");
  }
  glfwMakeContextCurrent(window);
  return window;
}

Result<Window> Window::Open(const WindowSettings& settings) {
  glfwSetErrorCallback([](int, const char* text) { LastError() = text; });
  if (!glfwInit()) {
    return NoGraphics("there is no display to open a window on",
                      "start the viewer from a desktop session, or over ssh with `ssh -X`; `percale shot`, `percale "
                      "render` and `percale simulate` need no display");
  }
  Window self;
  self.title_ = settings.title;
  const int asked = std::max(settings.samples, 0);
  Result<GLFWwindow*> made = Create(settings, asked == 0 ? 1 : asked);
  if (!made && asked > 1) made = Create(settings, 1);  // More than the card has.
  if (!made) {
    glfwTerminate();
    return made.diagnostics();
  }
  self.samples_ = std::max(asked, 1);
  if (asked == 0 && !DescribeGraphics().software) {
    if (Result<GLFWwindow*> smooth = Create(settings, kAutomaticSamples)) {
      glfwDestroyWindow(*made);
      made = *smooth;
      self.samples_ = kAutomaticSamples;
    }
    glfwMakeContextCurrent(*made);
  }
  GLFWwindow* const window = self.window_ = *made;
  if (settings.position && IsOnScreen(settings.position->first, settings.position->second))
    glfwSetWindowPos(window, settings.position->first, settings.position->second);
  self.uiScale_ = static_cast<float>(settings.uiScale);
  self.input_ = std::make_unique<Input>();
  glfwSetWindowUserPointer(window, self.input_.get());
  glfwSetKeyCallback(window, Callbacks::Key);
  glfwSetCharCallback(window, Callbacks::Character);
  glfwSetMouseButtonCallback(window, Callbacks::Button);
  glfwSetCursorPosCallback(window, Callbacks::Move);
  glfwSetScrollCallback(window, Callbacks::Wheel);
  glfwSetDropCallback(window, Callbacks::Drop);
  glfwSetFramebufferSizeCallback(window, Callbacks::Resized);
  glfwSetWindowContentScaleCallback(window, Callbacks::Scaled);
  glfwSetWindowFocusCallback(window, Callbacks::Focused);
  glfwSetWindowRefreshCallback(window, Callbacks::Refreshed);
  glfwSwapInterval(1);

  IMGUI_CHECKVERSION();
  self.context_ = ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // The panels stand where they belong at every start.
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 330");
  self.AdaptToScale();
  return self;
}

Window::Window(Window&& other) noexcept {
  *this = std::move(other);
}

Window& Window::operator=(Window&& other) noexcept {
  std::swap(window_, other.window_);
  std::swap(context_, other.context_);
  std::swap(input_, other.input_);
  std::swap(samples_, other.samples_);
  std::swap(scale_, other.scale_);
  std::swap(contentScale_, other.contentScale_);
  std::swap(uiScale_, other.uiScale_);
  std::swap(enterOwner_, other.enterOwner_);
  std::swap(title_, other.title_);
  return *this;
}

Window::~Window() {
  if (context_) {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext(context_);
  }
  if (!window_) return;
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::Show() {
  glfwShowWindow(window_);
}
void Window::Hide() {
  glfwHideWindow(window_);
}

void Window::WaitForEvents(double seconds) {
  if (seconds > 0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
}

void Window::Wake() {
  glfwPostEmptyEvent();
}

bool Window::TakeActivity() {
  return std::exchange(input_->activity, false);
}

std::vector<InputEvent> Window::TakeEvents() {
  return std::exchange(input_->events, {});
}

/// Fonts and sizes for the density of the display that the window is on.
void Window::AdaptToScale() {
  float contentScale = 1, unused = 1;
  glfwGetWindowContentScale(window_, &contentScale, &unused);
  contentScale = std::clamp(contentScale, 0.5f, 8.0f);
  if (contentScale == contentScale_) return;
  // Where a screen unit is several pixels (macOS), fonts are made as large as the pixels want them and
  // drawn smaller.
  int width = 1, height = 1, pixels = 1;
  glfwGetWindowSize(window_, &width, &height);
  glfwGetFramebufferSize(window_, &pixels, &height);
  const float pixelsPerUnit = width > 0 && pixels > 0 ? static_cast<float>(pixels) / static_cast<float>(width) : 1;
  contentScale_ = contentScale;
  const float wanted = uiScale_ > 0 ? uiScale_ * pixelsPerUnit : contentScale;  // [pixel]
  scale_ = wanted / pixelsPerUnit;
  ApplyStyle(scale_, wanted, pixelsPerUnit);
  ImGui_ImplOpenGL3_DestroyDeviceObjects();  // Made again, from the new fonts, with the next picture.
}

void Window::BeginPanels(bool keyboard) {
  AdaptToScale();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  FeedKeys(keyboard);
  ImGui::NewFrame();
#if IMGUI_VERSION_NUM < 18700
  for (const int key : input_->pressed) ImGui::GetIO().KeysDown[key] = glfwGetKey(window_, key) == GLFW_PRESS;
#endif
  input_->pressed.clear();
}

/// Which keys Dear ImGui sees in the picture to come.
void Window::FeedKeys(bool keyboard) {
  ImGuiIO& io = ImGui::GetIO();
  if (keyboard)
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  else
    io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
    // It is always to be seen where the keyboard is.
#if IMGUI_VERSION_NUM < 19140
  if (keyboard) GImGui->NavDisableHighlight = false;
#else
  if (keyboard) GImGui->NavCursorVisible = true;
#endif
#if IMGUI_VERSION_NUM < 18700  // Later versions queue what happens between two pictures, and let Enter press buttons.
  // A key that was let go before the picture came is down for one picture all the same.
  for (const int key : input_->pressed) io.KeysDown[key] = true;
  if (io.KeyCtrl) io.KeysDown[GLFW_KEY_TAB] = false;  // It is a key of ours, not for ImGui's list of windows.
  bool& enter = io.KeysDown[GLFW_KEY_ENTER];
  bool& keypadEnter = io.KeysDown[GLFW_KEY_KP_ENTER];
  if (!enter && !keypadEnter)
    enterOwner_ = Owner::None;
  else if (enterOwner_ == Owner::None)
    enterOwner_ = keyboard && !io.WantTextInput ? Owner::Panels : Owner::Text;
  if (enterOwner_ == Owner::Panels) {  // It does what Space does.
    enter = keypadEnter = false;
    io.NavInputs[ImGuiNavInput_Activate] = 1;
  }
#endif
}

void Window::FocusPanels(const char* name) {
  ImGuiWindow* const window = name ? ImGui::FindWindowByName(name) : nullptr;
  ImGui::FocusWindow(window);
  if (!window) return;
  ImGui::NavInitWindow(window, false);
}

void Window::EndPanels() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Window::OverPanels(double x, double y) {
  if (GImGui->OpenPopupStack.Size > 0) return true;
  const ImVec2 point(static_cast<float>(x), static_cast<float>(y));
  for (const ImGuiWindow* window : GImGui->Windows) {
    const bool shown = window->WasActive && !window->Hidden && !(window->Flags & ImGuiWindowFlags_NoMouseInputs);
    if (shown && window->Rect().Contains(point)) return true;
  }
  return false;
}

bool Window::HasLists() {
  return GImGui->OpenPopupStack.Size > 0;
}

void Window::CloseLists() {
  if (HasLists()) ImGui::ClosePopupToLevel(0, true);
}

void Window::FocusLastItem() {
  ImGui::FocusWindow(ImGui::GetCurrentContext()->CurrentWindow);
  ImGui::SetFocusID(ImGui::GetItemID(), GImGui->CurrentWindow);
}

void Window::Present() {
  glfwSwapBuffers(window_);
}

bool Window::ShouldClose() const {
  return glfwWindowShouldClose(window_) != 0;
}
bool Window::Minimized() const {
  return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0;
}

void Window::SetTitle(const std::string& title) {
  if (title == title_) return;
  title_ = title;
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::Size(int& width, int& height) const {
  glfwGetWindowSize(window_, &width, &height);
}
void Window::Place(int& x, int& y, int& width, int& height) const {
  glfwGetWindowPos(window_, &x, &y);
  glfwGetWindowSize(window_, &width, &height);
  int pixels = 1, unused = 1;
  glfwGetFramebufferSize(window_, &pixels, &unused);
  // What GLFW has made larger for the display's density, it will make larger again.
  const float factor = contentScale_ * static_cast<float>(width) / static_cast<float>(std::max(pixels, 1));
  width = static_cast<int>(std::lround(static_cast<float>(width) / factor));
  height = static_cast<int>(std::lround(static_cast<float>(height) / factor));
}
void Window::FramebufferSize(int& width, int& height) const {
  glfwGetFramebufferSize(window_, &width, &height);
}

}  // namespace percale::viewer
