// Gives programs the environment variables of Node.
Module.preRun = () => Object.assign(ENV, process.env);
