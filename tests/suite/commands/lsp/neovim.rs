//! Neovim of the distribution as a client: open, edit, error, completion, rename.

use std::process::Command;

use crate::support::Tree;
use crate::support::process::finish;

const SCRIPT: &str = r#"
local root = vim.fn.getcwd()
local function fail(what) io.stdout:write('failed: ' .. what .. '\n') vim.cmd('cquit 1') end
local function wait(what, fits) if not vim.wait(60000, fits, 20) then fail(what) end end
vim.cmd('edit brdf/ndf.glsl')
local id = vim.lsp.start_client({ name = 'specula', cmd = { vim.env.SPECULA, 'lsp' }, root_dir = root })
vim.lsp.buf_attach_client(0, id)
local client = vim.lsp.get_client_by_id(id)
wait('the start', function() return client.initialized end)
local function line_of(text)
  for number, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do if line:find(text, 1, true) then return number end end
  fail('no line ' .. text)
end
local function ask(method, more)
  local params = vim.tbl_extend('force', vim.lsp.util.make_position_params(0, client.offset_encoding), more or {})
  local answer = client.request_sync(method, params, 60000, 0)
  if not answer or answer.err then fail(method .. vim.inspect(answer)) end
  return answer.result
end

local number = line_of('float a2 = alpha * alpha;')
vim.api.nvim_buf_set_lines(0, number - 1, number, false, { '    float a2 = alpah * alpha;' })
wait('the error', function() return #vim.diagnostic.get(0) > 0 end)
local error = vim.diagnostic.get(0)[1]
io.stdout:write(string.format('error %d:%d %s\n', error.lnum + 1, error.col, error.message:gsub('\n', ' ')))
vim.api.nvim_buf_set_lines(0, number - 1, number, false, { '    float a2 = alpha * alpha;' })
wait('the end of the error', function() return #vim.diagnostic.get(0) == 0 end)
io.stdout:write('mended\n')

vim.api.nvim_win_set_cursor(0, { number + 1, 19 })
for _, item in ipairs(ask('textDocument/completion')) do
  if item.label == 'sin2_h' then io.stdout:write('completion ' .. item.detail .. '\n') end
end
vim.api.nvim_win_set_cursor(0, { line_of('float d_ggx(') , 8 })
local change = ask('textDocument/rename', { newName = 'd_trowbridge_reitz' })
vim.lsp.util.apply_workspace_edit(change, client.offset_encoding)
vim.cmd('silent wall')
io.stdout:write('renamed ' .. line_of('float d_trowbridge_reitz(') .. '\n')
client.stop()
wait('the end', function() return client.is_stopped() end)
vim.cmd('qall!')
"#;

#[test]
fn neovim_shows_errors_completes_and_renames() {
    let tree = Tree::new();
    let script = tree.beside("client.lua");
    std::fs::write(&script, SCRIPT).unwrap();
    let mut command = Command::new("nvim");
    command.args(["--headless", "--clean", "-n", "-S"]).arg(&script).current_dir(tree.root());
    command.env("SPECULA", env!("CARGO_BIN_EXE_specula"));
    // Its own folders, so that it leaves nothing in those of the user.
    for (name, folder) in [
        ("XDG_STATE_HOME", "state"),
        ("XDG_DATA_HOME", "data"),
        ("XDG_CONFIG_HOME", "config"),
        ("XDG_CACHE_HOME", "cache"),
    ] {
        command.env(name, tree.beside(folder));
    }
    if let Err(error) = Command::new("nvim").arg("--version").output() {
        panic!(
            "{error}: neovim is not installed, and the language server is not tested with an editor without it: apt-get install neovim"
        );
    }
    let finished = finish(&mut command);
    finished.expect(0, &[]);
    let out = &finished.stdout;
    assert!(out.contains("'alpah' : undeclared identifier help: did you mean `alpha`?"), "{finished:#?}");
    assert!(
        out.contains("mended") && out.contains("completion float sin2_h") && out.contains("renamed "),
        "{finished:#?}"
    );
    let text = tree.read("brdf/ndf.glsl");
    assert!(text.contains("float d_trowbridge_reitz(") && !text.contains("d_ggx("), "{text}");
}
