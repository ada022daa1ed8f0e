-- Uses `ros-lint lsp` as a user of Neovim does, and writes to the file $RESULT what the editor shows, as JSON.
-- $SERVER is the command of the server as a JSON list, $WORKSPACE a copy of fixtures/workspaces/demo.

local function wait(what, condition)
  if not vim.wait(60000, condition, 20) then
    error('not within 60 s: ' .. what)
  end
end

local function name(buffer)
  return vim.api.nvim_buf_get_name(buffer)
end

local function open(path)
  vim.cmd('edit ' .. vim.env.WORKSPACE .. '/' .. path)
end

local config = { name = 'ros-lint', cmd = vim.fn.json_decode(vim.env.SERVER), root_dir = vim.env.WORKSPACE }
local client = (vim.lsp.start or vim.lsp.start_client)(config)
vim.api.nvim_create_autocmd('BufReadPost', {
  callback = function(event)
    vim.lsp.buf_attach_client(event.buf, client)
  end,
})
local result = {}

open('src/rover_driver/src/driver_node.cpp')
local source = vim.api.nvim_get_current_buf()
wait('a diagnostic', function()
  return #vim.diagnostic.get(source) > 0
end)
result.diagnostics = vim.tbl_map(function(diagnostic)
  return diagnostic.message
end, vim.diagnostic.get(source))

vim.ui.select = function(items, _, choose)
  result.actions = #items
  choose(items[1], 1)
end
vim.fn.cursor(1, 1)
vim.fn.search('sensor_msgs')
vim.lsp.buf.code_action()
wait('the fix', function()
  return #vim.diagnostic.get(source) == 0
end)
for _, buffer in ipairs(vim.api.nvim_list_bufs()) do
  if vim.bo[buffer].modified then
    result[name(buffer)] = vim.api.nvim_buf_get_lines(buffer, 0, -1, false)
  end
end

open('src/rover_bringup/launch/rover.launch.py')
local launch = vim.api.nvim_get_current_buf()
vim.fn.search("'mission_server'")
vim.fn.search('server')
wait('the definition', function()
  if vim.api.nvim_get_current_buf() == launch then
    vim.lsp.buf.definition()
    vim.wait(500, function()
      return vim.api.nvim_get_current_buf() ~= launch
    end)
  end
  return vim.api.nvim_get_current_buf() ~= launch
end)
result.definition = { name(0), vim.api.nvim_get_current_line() }

vim.fn.writefile({ vim.fn.json_encode(result) }, vim.env.RESULT)
vim.cmd('qall!')
