// drop_files WINDOW FILE...: drops files onto the middle of a window, as a file manager does (XDND, version 5). Exit 0: the
// window took them; 1: it did not within five seconds.
#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

namespace {

/// The side that gives.
class Giver {
 public:
  Giver(Display* display, Window target) : display_(display), target_(target) {
    source_ = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0);
    XSetSelectionOwner(display, atom("XdndSelection"), source_, CurrentTime);
  }

  bool drop(const std::string& uris) {
    XWindowAttributes size;
    if (XGetWindowAttributes(display_, target_, &size) == 0) return false;
    int x = 0, y = 0;
    Window child = 0;
    XTranslateCoordinates(display_, target_, DefaultRootWindow(display_), size.width / 2, size.height / 2, &x, &y, &child);
    const auto word = [](unsigned long value) { return static_cast<long>(value); };
    send("XdndEnter", 5L << 24, word(atom("text/uri-list")), 0, 0);
    send("XdndPosition", 0, static_cast<long>(x) << 16 | y, CurrentTime, word(atom("XdndActionCopy")));
    const auto status = answer("XdndStatus", uris);
    if (!status || (status->data.l[1] & 1) == 0) return false;
    send("XdndDrop", 0, CurrentTime, 0, 0);
    return answer("XdndFinished", uris).has_value();
  }

 private:
  Atom atom(const char* name) const { return XInternAtom(display_, name, False); }

  void send(const char* type, long a, long b, long c, long d) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = target_;
    event.xclient.message_type = atom(type);
    event.xclient.format = 32;
    const long words[5] = {static_cast<long>(source_), a, b, c, d};
    std::copy(words, words + 5, event.xclient.data.l);
    XSendEvent(display_, target_, False, NoEventMask, &event);
    XFlush(display_);
  }

  /// The target's next message of that type; the files are named to who asks meanwhile.
  std::optional<XClientMessageEvent> answer(const char* type, const std::string& uris) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (std::chrono::steady_clock::now() < end) {
      if (XPending(display_) == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        continue;
      }
      XEvent event;
      XNextEvent(display_, &event);
      if (event.type == ClientMessage && event.xclient.message_type == atom(type)) return event.xclient;
      if (event.type == SelectionRequest) give(event.xselectionrequest, uris);
    }
    return std::nullopt;
  }

  void give(const XSelectionRequestEvent& asked, const std::string& uris) {
    XChangeProperty(display_, asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(uris.data()), static_cast<int>(uris.size()));
    XEvent event{};
    event.xselection.type = SelectionNotify;
    event.xselection.requestor = asked.requestor;
    event.xselection.selection = asked.selection;
    event.xselection.target = asked.target;
    event.xselection.property = asked.property;
    event.xselection.time = asked.time;
    XSendEvent(display_, asked.requestor, False, NoEventMask, &event);
    XFlush(display_);
  }

  Display* display_;
  Window target_, source_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  Display* display = XOpenDisplay(nullptr);
  if (argc < 3 || display == nullptr) {
    std::fprintf(stderr, "drop_files WINDOW FILE...: no window, no file or no display\n");
    return 2;
  }
  std::string uris;
  for (int i = 2; i < argc; ++i) uris += "file://" + std::string(argv[i]) + "\r\n";
  const bool taken = Giver(display, std::strtoul(argv[1], nullptr, 0)).drop(uris);
  XCloseDisplay(display);
  return taken ? 0 : 1;
}
