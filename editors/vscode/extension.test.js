"use strict";

// The extension with stubs of the editor and of the client library.

const assert = require("node:assert");
const Module = require("node:module");
const test = require("node:test");

function load(fails) {
  const log = { started: [], stopped: 0, errors: [], commands: {}, onChange: undefined };
  class LanguageClient {
    constructor(id, name, server, options) {
      this.server = server;
      this.options = options;
    }
    async start() {
      if (fails) throw new Error("spawn ros-lint ENOENT");
      log.started.push(this);
    }
    async stop() {
      log.stopped += 1;
    }
  }
  const settings = { command: "ros-lint", arguments: ["--distro", "jazzy"] };
  const vscode = {
    workspace: {
      getConfiguration: (section) => ({ get: (key) => (assert.equal(section, "ros-lint"), settings[key]) }),
      onDidChangeConfiguration: (listener) => void (log.onChange = listener),
    },
    commands: { registerCommand: (name, command) => void (log.commands[name] = command) },
    window: { showErrorMessage: (text) => log.errors.push(text) },
  };
  const stubs = { vscode, "vscode-languageclient/node": { LanguageClient } };
  const original = Module._load;
  Module._load = (request, ...rest) => stubs[request] ?? original(request, ...rest);
  try {
    delete require.cache[require.resolve("./extension.js")];
    return { ...require("./extension.js"), log };
  } finally {
    Module._load = original;
  }
}

test("the server gets the options of the user", async () => {
  const extension = load(false);
  await extension.activate({ subscriptions: [] });
  assert.deepEqual(extension.log.started[0].server, { command: "ros-lint", args: ["lsp", "--distro", "jazzy"] });
  await extension.deactivate();
  assert.equal(extension.log.stopped, 1);
});

test("a changed setting restarts the server", async () => {
  const extension = load(false);
  await extension.activate({ subscriptions: [] });
  await extension.log.onChange({ affectsConfiguration: (section) => section === "ros-lint" });
  assert.equal(extension.log.started.length, 2);
  assert.equal(extension.log.stopped, 1);
});

test("a missing program is explained", async () => {
  const extension = load(true);
  await extension.activate({ subscriptions: [] });
  assert.match(extension.log.errors[0], /pip install 'ros-lint\[lsp\]'/);
});
