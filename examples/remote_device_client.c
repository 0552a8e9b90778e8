/* A haptic device in a page of C: remote_device_client SOCKET [SECONDS]. It moves a hand that
   nobody holds down to 5 mm below z = 0 and up again, at 1 kHz, and tells the largest force
   (docs/remote_device.md). For little-endian machines: these structs are then the packets. Compile
   with cc -lm, nothing else. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

struct state {
  char magic[4];
  uint16_t version, flags;
  uint64_t sequence;
  double stamp, position[3], velocity[3];
  uint32_t buttons, reserved;
};
struct force {
  char magic[4];
  uint16_t version, flags;
  uint64_t sequence, answered;
  double stamp, newtons[3];
};
_Static_assert(sizeof(struct state) == 80 && sizeof(struct force) == 56, "no padding");
enum { HAS_VELOCITY = 1, LEAVING = 2, LIVE = 1, CLOSING = 2 };

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int usable(const struct force* f) { /* believe nothing that is not a good packet */
  return memcmp(f->magic, "plpF", 4) == 0 && f->version == 1 && isfinite(f->newtons[0]) &&
         isfinite(f->newtons[1]) && isfinite(f->newtons[2]);
}

int main(int count, char** arguments) {
  if (count < 2) return fprintf(stderr, "usage: %s SOCKET [SECONDS]\n", arguments[0]), 2;
  const double seconds = count > 2 ? atof(arguments[2]) : 2;
  struct sockaddr_un mine = {.sun_family = AF_UNIX}, theirs = {.sun_family = AF_UNIX};
  snprintf(theirs.sun_path, sizeof theirs.sun_path, "%s", arguments[1]);
  snprintf(mine.sun_path, sizeof mine.sun_path, "/tmp/palpate-client-%ld", (long)getpid());
  const int handle = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  if (bind(handle, (struct sockaddr*)&mine, sizeof mine) != 0) return perror(mine.sun_path), 1;
  struct state state = {.magic = "plpS", .version = 1};
  const double start = now();
  double heard = start, applied = 0, largest = 0;
  uint64_t seen = 0;
  int closing = 0, leaving = 0;
  for (double t = 0; !leaving && !closing; t = now() - start) {
    struct force f;
    while (recv(handle, &f, sizeof f, MSG_TRUNC) == sizeof f) {
      if (!usable(&f) || f.sequence <= seen) continue;
      seen = f.sequence;
      heard = now();
      closing = (f.flags & CLOSING) != 0;
      applied = closing ? 0
                        : sqrt(f.newtons[0] * f.newtons[0] + f.newtons[1] * f.newtons[1] +
                               f.newtons[2] * f.newtons[2]);
    }
    if (now() - heard > 0.1) applied = 0;     /* silence: motors get nothing */
    if (applied > largest) largest = applied; /* here a real device drives its motors */
    state.sequence++;
    state.stamp = 1 + t;
    state.position[2] = 5e-3 * (fabs(4 * fmin(t / seconds, 1) - 2) - 1);
    leaving = t >= seconds;
    if (leaving) state.flags = LEAVING;
    sendto(handle, &state, sizeof state, 0, (struct sockaddr*)&theirs, sizeof theirs);
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
  }
  unlink(mine.sun_path);
  printf("%llu states, %llu forces, largest %.3f N\n", (unsigned long long)state.sequence,
         (unsigned long long)seen, largest);
  return seen > 0 ? 0 : 1;
}
