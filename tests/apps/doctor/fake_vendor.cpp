// What the doctor asks of Force Dimension's library.
extern "C" void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = 3;
  *minor = 17;
  *release = 6;
  *revision = 0;
}
