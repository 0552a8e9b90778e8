// Gives programs the environment variables of Node. Where they have sanitizers, malloc() may fail as elsewhere; leaks are
// looked for in native builds.
Module.preRun = () => Object.assign(ENV, process.env);
Module.ASAN_OPTIONS = "allocator_may_return_null=1:detect_leaks=0";
