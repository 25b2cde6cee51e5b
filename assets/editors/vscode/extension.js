// Starts `specula lsp` and offers its commands.
'use strict';

const vscode = require('vscode');
const { LanguageClient, TransportKind } = require('vscode-languageclient/node');

let client;

function start() {
    const settings = vscode.workspace.getConfiguration('specula');
    const run = { command: settings.get('path'), args: ['lsp', ...settings.get('arguments')], transport: TransportKind.stdio };
    client = new LanguageClient('specula', 'Specula', { run, debug: run }, { documentSelector: [{ language: 'glsl' }] });
    return client.start();
}

async function restart() {
    if (client) await client.stop().catch(() => {});
    await start();
}

// The pixel of two numbers, `640,360`.
function pixel(text) {
    const found = /^\s*(\d+)\s*[,\s]\s*(\d+)\s*$/.exec(text);
    return found && [Number(found[1]), Number(found[2])];
}

async function askPixel() {
    const value = await vscode.window.showInputBox({
        title: 'Specula: values at a pixel',
        prompt: 'Pixel as X,Y, counted from the upper left corner',
        validateInput: (text) => (pixel(text) ? undefined : 'Two whole numbers, such as 640,360'),
    });
    if (value === undefined) return;
    const editor = vscode.window.activeTextEditor;
    const uri = editor ? client.code2ProtocolConverter.asUri(editor.document.uri) : undefined;
    const tracing = { location: vscode.ProgressLocation.Window, title: 'Specula traces the pixel' };
    await vscode.window.withProgress(tracing, async () => {
        try {
            const result = await execute('specula.pinPixel', [...pixel(value), ...(uri ? [uri] : [])]);
            vscode.window.setStatusBarMessage(`Specula: pixel ${result.pixel.join(',')}, ${result.proof}`, 10000);
        } catch (error) {
            vscode.window.showErrorMessage(`Specula: ${error.message}`);
        }
    });
}

async function showWindow() {
    const editor = vscode.window.activeTextEditor;
    const uri = editor ? client.code2ProtocolConverter.asUri(editor.document.uri) : undefined;
    try {
        await execute('specula.openWindow', uri ? [uri] : []);
    } catch (error) {
        vscode.window.showErrorMessage(`Specula: ${error.message}`);
    }
}

function execute(command, args) {
    return client.sendRequest('workspace/executeCommand', { command, arguments: args });
}

async function activate(context) {
    const register = (name, run) => context.subscriptions.push(vscode.commands.registerCommand(name, run));
    register('specula.askPixel', askPixel);
    register('specula.hideValues', () => execute('specula.unpinPixel', []));
    register('specula.showWindow', showWindow);
    register('specula.restart', restart);
    context.subscriptions.push(vscode.workspace.onDidChangeConfiguration((change) => {
        if (change.affectsConfiguration('specula')) restart();
    }));
    try {
        await start();
    } catch (error) {
        vscode.window.showErrorMessage(`Specula does not start: ${error.message}. Set specula.path to the program.`);
    }
}

function deactivate() {
    return client ? client.stop() : undefined;
}

module.exports = { activate, deactivate, pixel };
