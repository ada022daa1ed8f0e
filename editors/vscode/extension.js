"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

const LANGUAGES = ["xml", "cmake", "python", "cpp", "c", "yaml", "toml", "ini"];

let client;

/** Start the language server with the settings of the user. */
async function start() {
  const settings = vscode.workspace.getConfiguration("ros-lint");
  const server = { command: settings.get("command"), args: ["lsp", ...settings.get("arguments")] };
  const documents = [...LANGUAGES.map((language) => ({ scheme: "file", language })), { scheme: "file", pattern: "**/*.launch" }];
  client = new LanguageClient("ros-lint", "ros-lint", server, { documentSelector: documents });
  try {
    await client.start();
  } catch (error) {
    const text = `ros-lint did not start: ${error.message}. Install it with: pip install 'ros-lint[lsp]'`;
    vscode.window.showErrorMessage(text);
  }
}

/** Stop the language server, if it runs. */
async function stop() {
  await client?.stop();
  client = undefined;
}

async function restart() {
  await stop();
  await start();
}

async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("ros-lint.restart", restart),
    vscode.workspace.onDidChangeConfiguration((event) => event.affectsConfiguration("ros-lint") && restart()),
  );
  await start();
}

module.exports = { activate, deactivate: stop };
