// Starts `specula lsp` and offers its commands.
'use strict';

const vscode = require('vscode');
const { LanguageClient, TransportKind } = require('vscode-languageclient/node');

let client;
// Starts and stops follow each other: a client that is starting cannot be stopped.
let last = Promise.resolve();

async function start() {
    const settings = vscode.workspace.getConfiguration('specula');
    const run = { command: settings.get('path'), args: ['lsp', ...settings.get('arguments')], transport: TransportKind.stdio };
    client = new LanguageClient('specula', 'Specula', { run, debug: run }, { documentSelector: [{ language: 'glsl' }] });
    try {
        await client.start();
    } catch (error) {
        offerSettings(`\`${[run.command, ...run.args].join(' ')}\` does not start: ${reason(error)}`);
    }
}

async function stop() {
    const stopped = client;
    client = undefined;
    // A client that has not started cannot be stopped, and leaves no process.
    await stopped?.stop().catch(() => {});
}

function restart() {
    last = last.then(stop).then(start);
    return last;
}

// The text of an error; the client rejects with strings, too.
function reason(error) {
    return error?.message ?? String(error);
}

async function offerSettings(message) {
    const [settings, output] = ['Open Settings', 'Show Output'];
    const chosen = await vscode.window.showErrorMessage(`Specula: ${message}`, settings, output);
    if (chosen === settings) vscode.commands.executeCommand('workbench.action.openSettings', 'specula.');
    if (chosen === output) client?.outputChannel.show();
}

// The pixel of two numbers, `640,360`.
function pixel(text) {
    const found = /^\s*(\d+)\s*[,\s]\s*(\d+)\s*$/.exec(text);
    return found && [Number(found[1]), Number(found[2])];
}

// The file in the editor, if it is one of shaders.
function activeUri() {
    const document = vscode.window.activeTextEditor?.document;
    return document?.languageId === 'glsl' ? [document.uri.toString()] : [];
}

async function askPixel() {
    const value = await vscode.window.showInputBox({
        title: 'Specula: values at a pixel',
        prompt: 'Pixel as X,Y, counted from the upper left corner',
        validateInput: (text) => (pixel(text) ? undefined : 'Two whole numbers, such as 640,360'),
    });
    if (value === undefined) return;
    const tracing = { location: vscode.ProgressLocation.Window, title: 'Specula traces the pixel' };
    await vscode.window.withProgress(tracing, async () => {
        const result = await execute('specula.pinPixel', [...pixel(value), ...activeUri()]);
        vscode.window.setStatusBarMessage(`Specula: pixel ${result.pixel.join(',')}, ${result.proof}`, 10000);
    });
}

async function execute(command, args) {
    // A server that is being restarted answers once it runs.
    await last;
    if (!client?.isRunning()) throw new Error('the language server is not running');
    return client.sendRequest('workspace/executeCommand', { command, arguments: args });
}

function activate(context) {
    const register = (name, run) => {
        const shown = () => run().catch((error) => vscode.window.showErrorMessage(`Specula: ${reason(error)}`));
        context.subscriptions.push(vscode.commands.registerCommand(name, shown));
    };
    register('specula.askPixel', askPixel);
    register('specula.hideValues', () => execute('specula.unpinPixel', []));
    register('specula.showWindow', () => execute('specula.openWindow', activeUri()));
    register('specula.restart', restart);
    context.subscriptions.push(vscode.workspace.onDidChangeConfiguration((change) => {
        if (change.affectsConfiguration('specula')) restart();
    }));
    return restart();
}

function deactivate() {
    last = last.then(stop);
    return last;
}

module.exports = { activate, deactivate, pixel };
