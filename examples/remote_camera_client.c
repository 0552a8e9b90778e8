/* A depth camera in a page of C: remote_camera_client SOCKET [SECONDS]. It sends a made-up wall,
   0.7 m away, that moves to and fro by 5 mm, 30 times a second (docs/remote_camera.md). For
   little-endian machines: this struct is then the header. Compile with cc -lm, nothing else. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

struct header {
  char magic[4];
  uint16_t version, flags;
  uint32_t width, height;
  double unit, fx, fy, cx, cy, distortion[5], stamp, position[3], quaternion[4];
};
_Static_assert(sizeof(struct header) == 160, "no padding");
enum { HAS_POSE = 1, HAS_STAMP = 2, FLOATS = 4, WIDTH = 320, HEIGHT = 240 };

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* All of it, however often that takes. 0: palpate has closed the connection. */
static int send_all(int handle, const void* bytes, size_t size) {
  for (const char* at = bytes; size > 0;) {
    const ssize_t sent = send(handle, at, size, MSG_NOSIGNAL);
    if (sent <= 0) return 0;
    at += sent;
    size -= (size_t)sent;
  }
  return 1;
}

/* It says why before it closes, unless it has ended. */
static int closed(int handle) {
  char why[1000] = "palpate has ended\n";
  const ssize_t got = recv(handle, why, sizeof why - 1, 0);
  if (got > 0) why[got] = '\0';
  return fputs(why, stderr), 1;
}

int main(int count, char** arguments) {
  if (count < 2) return fprintf(stderr, "usage: %s SOCKET [SECONDS]\n", arguments[0]), 2;
  const double seconds = count > 2 ? atof(arguments[2]) : INFINITY;
  struct sockaddr_un theirs = {.sun_family = AF_UNIX};
  snprintf(theirs.sun_path, sizeof theirs.sun_path, "%s", arguments[1]);
  const int handle = socket(AF_UNIX, SOCK_STREAM, 0);
  if (connect(handle, (struct sockaddr*)&theirs, sizeof theirs) != 0) {
    return perror(theirs.sun_path), 1;
  }
  static uint16_t depth[WIDTH * HEIGHT];
  struct header header = {.magic = "plpD", .version = 1, .flags = HAS_STAMP, .width = WIDTH,
                          .height = HEIGHT, .unit = 1e-4, .fx = 285, .fy = 285, .cx = 159.5, .cy = 119.5};
  const double start = now();
  int frames = 0;
  for (; now() - start < seconds; ++frames) {
    header.stamp = now();
    const double z = 7000 + 50 * sin(2 * 3.14159265358979 * (header.stamp - start) / 4);
    for (int i = 0; i < WIDTH * HEIGHT; ++i) depth[i] = (uint16_t)lround(z); /* steps of 0.1 mm */
    if (!send_all(handle, &header, sizeof header) || !send_all(handle, depth, sizeof depth)) {
      return closed(handle);
    }
    nanosleep(&(struct timespec){.tv_nsec = 33333333}, NULL);
  }
  close(handle);
  printf("%d frames\n", frames);
  return 0;
}
