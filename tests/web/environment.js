// Gives programs the environment variables of Node. Where they have sanitizers, malloc() may fail as elsewhere, of what was
// freed so much is kept that hostile files still fit (MB), and leaks are looked for in native builds alone.
Module.preRun = () => Object.assign(ENV, process.env);
Module.ASAN_OPTIONS = "allocator_may_return_null=1:quarantine_size_mb=16:detect_leaks=0";
